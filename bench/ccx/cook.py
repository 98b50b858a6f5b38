#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reference of the problem cook_membrane of `carus verify`, by CalculiX: stiffness per thickness of Cook's membrane in
plane strain whose loaded edge moves up as one. n x n bricks of 20 nodes with reduced integration; G = 20 kPa, linear.

    bench/ccx/cook.py [N]        prints nu and the stiffness [Pa]; N = 64 by default
"""
import pathlib
import subprocess
import sys
import tempfile

SHEAR, UP = 20e3, 1.0  # [Pa], [mm]; lengths in mm, so that forces are in 1e-6 N


def deck(n, nu):
    young = 2 * SHEAR * (1 + nu)
    width = 16.0 / n
    node, lines = {}, ["*NODE, NSET=ALL"]

    def at(i, j, k):  # in half cells along x and z, k: 0, 1, 2 through the thickness
        key = (i, j, k)
        if key not in node:
            node[key] = len(node) + 1
            q, r = i / (2 * n), k / (2 * n)
            lines.append(f"{node[key]}, {48 * q!r}, {width * j / 2!r}, {44 * q + r * (44 + 16 * q - 44 * q)!r}")
        return node[key]

    elements = []
    for a in range(n):
        for c in range(n):
            i, k = 2 * a, 2 * c
            corner = [(i, 0, k), (i + 2, 0, k), (i + 2, 2, k), (i, 2, k)]
            corner += [(x, y, k + 2) for x, y, _ in corner]
            mid = lambda p, q: tuple((u + v) // 2 for u, v in zip(p, q))
            bottom = [mid(corner[e], corner[(e + 1) % 4]) for e in range(4)]
            top = [mid(corner[4 + e], corner[4 + (e + 1) % 4]) for e in range(4)]
            sides = [mid(corner[e], corner[4 + e]) for e in range(4)]
            elements.append([at(*p) for p in corner + bottom + top + sides])
    lines.append("*ELEMENT, TYPE=C3D20R, ELSET=SOLID")
    for e, nodes in enumerate(elements):
        text = [str(e + 1)] + [str(m) for m in nodes]
        lines.append(", ".join(text[:15]) + ",\n" + ", ".join(text[15:]))
    clamp = [m for (i, j, k), m in node.items() if i == 0]
    edge = [m for (i, j, k), m in node.items() if i == 2 * n]
    for name, members in (("CLAMP", clamp), ("EDGE", edge)):
        lines += [f"*NSET, NSET={name}"] + [f"{m}," for m in members]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{young!r}, {nu!r}", "*SOLID SECTION, ELSET=SOLID, MATERIAL=M", "*STEP",
              "*STATIC", "*BOUNDARY", "ALL, 2, 2, 0", "CLAMP, 1, 3, 0", f"EDGE, 3, 3, {UP}",
              "*NODE PRINT, NSET=EDGE, TOTALS=ONLY", "RF", "*END STEP"]
    return "\n".join(lines) + "\n", width


def stiffness(n, nu):
    text, width = deck(n, nu)
    with tempfile.TemporaryDirectory() as folder:
        base = pathlib.Path(folder) / "cook"
        base.with_suffix(".inp").write_text(text)
        subprocess.run(["ccx", str(base)], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        numbers = base.with_suffix(".dat").read_text().split()
        return float(numbers[-1]) / (UP * width)  # the last of the three components


if __name__ == "__main__":
    cells = int(sys.argv[1]) if len(sys.argv) > 1 else 64
    for poisson in (0.3, 0.49, 0.499):
        print(poisson, stiffness(cells, poisson))

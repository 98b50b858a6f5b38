#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws birth.png from a results folder: sagittal cuts (x = 0) of the tetrahedra at several times of the labour.

Usage: birth.py RESULTS OUT.png [minutes ...]      needs Debian's python3-vtk9 and python3-pil
"""
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

from PIL import Image, ImageDraw
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

COLOURS = {"fetus": (233, 196, 160), "uterus": (196, 78, 82), "abdomen": (140, 172, 211), "bone": (239, 236, 214)}
BONES = ("innominate_right", "innominate_left", "sacrum", "coccyx")
SCALE, LEFT, TOP, WIDTH, HEIGHT = 2.0, -150, 320, 330, 560  # pixels per mm; mm


def section(grid, names):
    """Polygons (kind, [(y, z) mm]) where the plane x = 0 cuts the tets."""
    points, region = grid.GetPoints(), grid.GetCellData().GetArray("region")
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        x = [points.GetPoint(cell.GetPointId(i)) for i in range(4)]
        cut = []
        for i in range(4):
            for j in range(i + 1, 4):
                if (x[i][0] < 0) != (x[j][0] < 0):
                    t = x[i][0] / (x[i][0] - x[j][0])
                    cut.append(tuple(1000 * (x[i][k] + t * (x[j][k] - x[i][k])) for k in (1, 2)))
        if len(cut) < 3:
            continue
        my, mz = sum(p[0] for p in cut) / len(cut), sum(p[1] for p in cut) / len(cut)
        from math import atan2
        cut.sort(key=lambda p: atan2(p[1] - mz, p[0] - my))
        yield names[int(region.GetTuple1(c))], cut


def names_of(grid):
    """Kind of organ by region index, from the field data's names."""
    array = grid.GetFieldData().GetAbstractArray("region_names")
    regions = [array.GetValue(i) for i in range(array.GetNumberOfValues())]
    kinds = []
    for r in regions:
        kinds.append("bone" if r in BONES else "fetus" if r in ("skull", "fetal_body", "fetal_skin", "neck")
                     else "uterus" if r in ("uterine_fundus", "uterine_body", "lower_segment", "vaginal_canal") else "abdomen")
    return kinds


def main():
    results, out = Path(sys.argv[1]), sys.argv[2]
    minutes = [float(m) for m in sys.argv[3:]] or [0, 8, 16, 24, 30]
    frames = [(float(d.get("timestep")), d.get("file")) for d in ET.parse(results / "frames.pvd").iter("DataSet")]
    picture = Image.new("RGB", (int(WIDTH * SCALE) * len(minutes), int(HEIGHT * SCALE)), "white")
    draw = ImageDraw.Draw(picture)
    for column, minute in enumerate(minutes):
        time, file = min(frames, key=lambda f: abs(f[0] - 60 * minute))
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(results / file))
        reader.Update()
        grid = reader.GetOutput()
        dx = column * WIDTH * SCALE
        for kind, polygon in section(grid, names_of(grid)):
            draw.polygon([(dx + (y - LEFT) * SCALE, (TOP - z) * SCALE) for y, z in polygon], fill=COLOURS[kind], outline=(110, 110, 110))
        draw.text((dx + 12, 12), f"{time / 60:.1f} min", fill=(0, 0, 0))
    picture = picture.resize((picture.width // 2, picture.height // 2), Image.LANCZOS)
    picture.save(out)


if __name__ == "__main__":
    main()

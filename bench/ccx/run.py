#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cross-check with CalculiX: the same mesh, material and displacements computed by both, paired in one run.

    bench/ccx/run.py [SCENARIO] [--carus FILE] [--threads N ...] [--repeats N]

Prints reaction, difference, seconds (wall and processor, least of the repetitions) and their ratio, the verdict last.
Exit status 0: within 1 %; 1: not; 77: skipped, because ccx is not there (apt install calculix-ccx).
"""
import argparse
import csv
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def timed(command, folder, threads):
    env = dict(os.environ, OMP_NUM_THREADS=str(threads), CCX_NPROC_EQUATION_SOLVER=str(threads))
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(command, cwd=folder, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    wall = time.monotonic() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout[-2000:]}")
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def ccx_reaction(dat):
    """Sum of the forces along z of the last set printed."""
    found = re.findall(r"total force \(fx,fy,fz\) for set (\S+) and time .*\n\s*\n\s*(\S+)\s+(\S+)\s+(\S+)", dat.read_text())
    if not found:
        sys.exit(f"{dat}: no total force; did ccx converge?")
    return float(found[-1][3])


def carus_reaction(folder):
    rows = list(csv.DictReader(open(folder / "curves.csv")))
    columns = [name for name in rows[-1] if name.endswith("_rz_n")]
    return float(rows[-1][columns[-1]])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenario", nargs="?", default=HERE / "block.yaml", type=pathlib.Path)
    parser.add_argument("--carus", default=ROOT / "build/release/bin/carus", type=pathlib.Path)
    parser.add_argument("--threads", nargs="+", type=int, default=[1, 2])
    parser.add_argument("--repeats", type=int, default=1)
    a = parser.parse_args()
    if shutil.which("ccx") is None:
        print("SKIPPED: ccx is not there; apt install calculix-ccx")
        return 77
    met = True
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        deck = folder / "model.inp"
        timed([a.carus, "export", "ccx", a.scenario.resolve(), "--out", deck], folder, 1)
        print(f"{'threads':>7} {'ccx [N]':>12} {'carus [N]':>12} {'difference':>10} "
              f"{'ccx wall/cpu [s]':>18} {'carus wall/cpu [s]':>18} {'faster (wall)':>13}")
        for threads in a.threads:
            theirs, ours = [], []
            for _ in range(a.repeats):
                theirs.append(timed(["ccx", "model"], folder, threads))
                ours.append(timed([str(a.carus), "run", str(a.scenario.resolve()), "--out", str(folder / "out"), "--threads",
                                   str(threads)], folder, threads))
            f, g = ccx_reaction(folder / "model.dat"), carus_reaction(folder / "out")
            error = abs(g / f - 1)
            met = met and error < 0.01
            t, o = min(theirs), min(ours)
            print(f"{threads:7d} {f:12.4f} {g:12.4f} {100 * error:8.3f} % {t[0]:9.2f} /{t[1]:7.2f} {o[0]:9.2f} /{o[1]:7.2f} "
                  f"{t[0] / o[0]:11.2f} x")
    print("MET: reactions within 1 %" if met else "NOT MET: reactions differ by more than 1 %")
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())

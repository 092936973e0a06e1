#!/usr/bin/python3
"""Prints what `mesh_boolean --json FILE` tells about cells as a table: a row for each winding-number vector.

    print_windings.py FILE

Volumes are added up exactly, from the file's num/den strings. If the operation was the union of all, those of the cells inside any
mesh must add up to its volume, as rationals; exit status 1 if not.
"""
import collections
import fractions
import json
import pathlib
import sys


def main():
    if hasattr(sys, "set_int_max_str_digits"):
        sys.set_int_max_str_digits(0)  # exact volumes have thousands of digits
    report = json.loads(pathlib.Path(sys.argv[1]).read_text())
    for i, mesh in enumerate(report["input"]):
        print(f"mesh {i}: {pathlib.Path(mesh['mesh']).name}, {mesh['triangles']} triangles")
    cells, volumes = collections.Counter(), collections.defaultdict(fractions.Fraction)
    for cell in report["winding"][1:]:  # without the unbounded one
        key = tuple(cell["vector"])
        cells[key] += 1
        volumes[key] += fractions.Fraction(cell["exact"])
    print(f"{'winding numbers':<20} {'cells':>8} {'volume':>14}")
    for key in sorted(cells, reverse=True):
        print(f"{' '.join(map(str, key)):<20} {cells[key]:>8} {float(volumes[key]):>14.8f}")
    inside = sum((volume for key, volume in volumes.items() if any(w > 0 for w in key)), fractions.Fraction(0))
    print(f"{'inside any':<20} {'':>8} {float(inside):>14.8f}")
    output = report["output"]
    print(f"{report['operation']}: {output['faces']} triangles, volume {output['volume']:.8f}, Euler characteristic {output['euler']}")
    if report["operation"] == "union" and inside != fractions.Fraction(output["exact_volume"]):
        sys.exit("the cells do not add up to the union")


if __name__ == "__main__":
    main()

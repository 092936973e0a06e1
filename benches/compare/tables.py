"""Prints the results that scripts/bench left in a folder as Markdown: tables.py FOLDER.

Of cuts, every ratio is a peer's time divided by the library's on one thread, both from one run of bench_cut: 40 x means that the peer
takes 40 times as long. Of booleans it is the other way round, as their goals are: 0.35 means that the library takes 35 % of the peer's time.
"""
import json
import pathlib
import sys

PEERS = {"pmp-epick": "PMP, rounded", "pmp-epeck": "PMP, exact", "nef": "Nef, exact"}

# What the library is to stay below: its time divided by corefinement's, or ms, or MB; and what two threads are to gain.
BOOLEAN_GOALS = {"two bunnies": "0.35", "two rocker-arms": "0.7", "two cubes of squares": "0.3", "50 cubes": "100 ms",
                 "two spheres": "0.35, 500 MB, 1.5 x"}


def read(folder, table):
    return [json.loads(path.read_text()) for path in sorted(folder.glob(table + "-*.json"))]


def results(report):
    return {one["name"]: one for one in report["results"]}


def ms(seconds):
    digits = 0 if seconds >= 0.1 else 1 if seconds >= 0.01 else 2
    return f"{seconds * 1e3:.{digits}f}"


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def head(left, right):
    row(*left, *right)
    row(*["---"] * len(left), *["---:"] * len(right))


def ours(one, key="seconds"):
    return f"failed: {one['error']}" if "error" in one else ms(one[key])


def failure(one):
    """Why there is no result; nothing if there is one."""
    if "error" not in one:
        return ""
    return f"> {one['limit_seconds']:.0f} s" if "limit_seconds" in one else f"failed: {one['error']}"


def peer(one, base):
    """Time and ratio; what is wrong, if anything is."""
    if one is None:
        return ""
    if "error" in one:
        return failure(one)
    text = ms(one["seconds"])
    if "error" not in base:
        ratio = one["seconds"] / base["seconds"]
        text += f" ({ratio:.0f} x)" if ratio >= 10 else f" ({ratio:.1f} x)"
        if one["cells"] != base["cells"]:
            text += f", {one['cells']} cells"
        elif abs(one["volume"] - base["volume"]) > 1e-9 * abs(base["volume"]):
            text += f", volume {one['volume']:.12g} instead of {base['volume']:.12g}"
    return text


def memory(one):
    return "" if one is None or "error" in one else f"{one['memory_bytes'] / 2**20:.0f}"


def compare(reports):
    print("Times in ms. In brackets how many times as long as Lapidary on one thread; where a peer's cells differ, its number.\n")
    head(["mesh", "planes"], ["triangles", "cells", "Lapidary", "with moments", *PEERS.values()])
    for report in reports:
        by_name = results(report)
        base = by_name["lapidary-1"]
        row(report["mesh"], report["plane_set"], report["triangles"], base.get("cells", ""), ours(base),
            ours(base, "seconds_with_moments"), *(peer(by_name.get(name), base) for name in PEERS))
    print("\nMemory in MiB that the first run takes beyond the input arrays.\n")
    head(["mesh", "planes"], ["Lapidary", *PEERS.values()])
    for report in reports:
        by_name = results(report)
        row(report["mesh"], report["plane_set"], *(memory(by_name.get(name)) for name in ["lapidary-1", *PEERS]))


def growth(reports, what):
    print(f"\nLapidary alone, as {what} grow; times in ms.\n")
    head(["mesh", "planes"], ["triangles", "cells", "1 thread", "with moments", "2 threads", "with moments"])
    for report in reports:
        one, two = (results(report)[name] for name in ("lapidary-1", "lapidary-2"))
        times = [ours(r, key) for r in (one, two) for key in ("seconds", "seconds_with_moments")]
        row(report["mesh"], report["plane_set"], report["triangles"], one.get("cells", ""), *times)


def goals(reports):
    """Each row's name says what it is to stay below, in ms; the sphere's rows also give the cost of a face."""
    print("\nLapidary against its goals: mesh and cut, ms, one thread; then what two threads gain, a cut of a mesh that is there already, new "
          "coordinates for it, and memory (MiB beyond the input, moments of all cells included).\n")
    head(["mesh", "planes"], ["goal", "1 thread", "2 threads", "gain", "prepared", "moved", "faces", "memory"])
    by_planes = {}
    for report, goal in reports:
        one, two = (results(report)[name] for name in ("lapidary-1", "lapidary-2"))
        if "error" in one or "error" in two:
            row(report["mesh"], report["plane_set"], goal, ours(one), ours(two))
            continue
        by_planes[report["mesh"], report["planes"]] = one
        row(report["mesh"], report["plane_set"], goal, ours(one), ours(two), f"{one['seconds'] / two['seconds']:.2f} x",
            ms(one["seconds_prepared"]), ms(one["seconds_moved"]), one["faces"], memory(one))
    few, many = by_planes.get(("icosphere:8", 75)), by_planes.get(("icosphere:8", 300))
    if few and many:
        each = (many["seconds"] - few["seconds"]) / (many["faces"] - few["faces"])
        print(f"\nA face more of the sphere, from 25 to 100 planes per axis: {each * 1e6:.2f} µs (goal 0.7).")
    print("\nEach row: `build/bench/bin/bench_cut MESH --grid N N N` (or `--random N`) `--peers none --repeat R`, as in scripts/bench.")


def wrong_union(one, base):
    """What differs between a peer's union and the library's, if anything does."""
    if abs(one["volume"] - base["volume"]) <= 1e-9 * abs(base["volume"]):
        return ""
    return f", volume {one['volume']:.12g} instead of {base['volume']:.12g}"


def booleans(reports):
    print("\n## Booleans\n\nUnions of meshes, times in ms on one thread; ratio: Lapidary's time divided by that of CGAL's corefinement; what two "
          "threads gain; the peak of Lapidary's memory in MB, program and input included.\n")
    head(["case"], ["triangles", "Lapidary", "CGAL", "ratio", "goal", "two threads", "MB"])
    for report in reports:
        by_name = results(report)
        one, two, cgal = (by_name[name] for name in ("lapidary-1", "lapidary-2", "corefinement"))
        ratio = gain = peak = ""
        theirs = failure(cgal) or ms(cgal["seconds"])
        if "error" not in one:
            peak = f"{one['peak_bytes'] / 1e6:.0f}"
            gain = f"{one['seconds'] / two['seconds']:.2f} x" if "error" not in two else ours(two)
            if "error" not in cgal:
                ratio = f"{one['seconds'] / cgal['seconds']:.2f}"
                theirs += wrong_union(cgal, one)
        row(report["case"], report["triangles"], ours(one), theirs, ratio, BOOLEAN_GOALS.get(report["case"], ""), gain, peak)
    print("\nThe commands are those of scripts/bench: `build/bench/bin/bench_boolean CASE`.")


def goals_of(folder):
    """Files goal-NUMBER-MILLISECONDS.json."""
    return [(json.loads(path.read_text()), path.stem.split("-")[2]) for path in sorted(folder.glob("goal-*.json"))]


def main():
    folder = pathlib.Path(sys.argv[1])
    compare(read(folder, "compare"))
    growth(read(folder, "planes"), "planes")
    growth(read(folder, "triangles"), "triangles")
    goals(goals_of(folder))
    booleans(read(folder, "boolean"))


main()

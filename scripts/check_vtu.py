#!/usr/bin/python3
"""Opens a .vtu that `cut_mesh --vtu` or `cut_grid --vtu` wrote with VTK's own reader and compares it with the .json of the same
run.

    check_vtu.py CELLS.vtu COUNTS.json

Checks, all of them exactly: every cell is a polyhedron, then come hexahedra; as many of both, and as many points, as the JSON says;
the polyhedra's volumes in the file are the JSON's, bit for bit; and each polyhedron is closed: every directed edge of its faces
is met by its reverse.
Exit status: 0 fine, 1 something differs, 77 VTK for Python is not installed.
"""

import json
import sys
from collections import Counter

try:
    from vtkmodules.vtkCommonCore import vtkIdList
    from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_POLYHEDRON
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as error:
    print(f"skipped: VTK for Python is not installed ({error})")
    sys.exit(77)


def faces_of(grid, cell):
    """The faces of a polyhedron as tuples of point ids."""
    stream = vtkIdList()
    grid.GetFaceStream(cell, stream)
    ids = [stream.GetId(i) for i in range(stream.GetNumberOfIds())]
    at, faces = 1, []
    for _ in range(ids[0]):
        faces.append(tuple(ids[at + 1 : at + 1 + ids[at]]))
        at += 1 + ids[at]
    return faces


def problems(grid, counts):
    """What is wrong with the grid, as sentences."""
    output = counts["output"]
    cells, hexahedra = output["cells"], output.get("hexahedra", 0)
    if grid.GetNumberOfCells() != cells + hexahedra:
        yield f"{grid.GetNumberOfCells()} cells, the JSON says {cells} and {hexahedra} hexahedra"
        return
    points = output["vertices"] + output.get("hexahedra_points", 0)
    if grid.GetNumberOfPoints() != points:
        yield f"{grid.GetNumberOfPoints()} points, the JSON says {points}"
    volume = grid.GetCellData().GetArray("volume")
    if [volume.GetValue(i) for i in range(cells)] != counts["cell_volumes"]:
        yield "the cells' volumes differ from the JSON's"
    for cell in range(cells, cells + hexahedra):
        if grid.GetCellType(cell) != VTK_HEXAHEDRON:
            yield f"cell {cell} is not a hexahedron"
    for cell in range(cells):
        if grid.GetCellType(cell) != VTK_POLYHEDRON:
            yield f"cell {cell} is not a polyhedron"
            continue
        edges = Counter()
        for face in faces_of(grid, cell):
            for a, b in zip(face, face[1:] + face[:1]):
                edges[a, b] += 1
                edges[b, a] -= 1
        if any(edges.values()):
            yield f"cell {cell} is not closed"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(sys.argv[1])
    reader.Update()
    grid = reader.GetOutput()
    with open(sys.argv[2], encoding="utf-8") as file:
        counts = json.load(file)
    found = list(problems(grid, counts))
    for problem in found:
        print(f"{sys.argv[1]}: {problem}")
    if found:
        sys.exit(1)
    hexahedra = counts["output"].get("hexahedra", 0)
    more = f" and {hexahedra} hexahedra" if hexahedra else ""
    closed = grid.GetNumberOfCells() - hexahedra
    print(f"{sys.argv[1]}: VTK reads {closed} closed polyhedra{more} on {grid.GetNumberOfPoints()} points")


if __name__ == "__main__":
    main()

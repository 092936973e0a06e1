#!/usr/bin/python3
"""Renders a slice through the cells that `cut_grid --vtu FILE.vtu --full` writes, coloured by volume fraction, to a PNG.

    render_slice.py CELLS.vtu PICTURE.png [--axis z] [--at 0.5] [--size 1600]

The slice lies in the grid plane across `axis` that is nearest to the fraction `at` of the extent: there every cell on the plane's
lower side has its faces exactly, so the picture shows the shapes of the cut cells and not squares. Full boxes are grey. Draws off
screen, but Debian's VTK still wants an X server: call it as `xvfb-run -a render_slice.py ...` on a machine without a display.
"""

import argparse
import sys

from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIdList, vtkLookupTable
from vtkmodules.vtkCommonDataModel import VTK_POLYHEDRON, vtkCellArray, vtkPolyData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
import vtkmodules.vtkRenderingFreeType  # noqa: F401  (draws the text)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (draws the rest)

GREY = (0.80, 0.82, 0.84)
# From nearly empty to nearly full: perceptually even, and readable without telling red from green.
RAMP = [
    (0.00, (0.27, 0.00, 0.33)),
    (0.25, (0.23, 0.32, 0.55)),
    (0.50, (0.13, 0.57, 0.55)),
    (0.75, (0.37, 0.79, 0.38)),
    (1.00, (0.99, 0.91, 0.14)),
]


def colours(fractions=256):
    """A lookup table over [0, 1]."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(fractions)
    table.SetTableRange(0, 1)
    for i in range(fractions):
        x = i / (fractions - 1)
        (x0, a), (x1, b) = next((p, q) for p, q in zip(RAMP, RAMP[1:]) if x <= q[0])
        t = (x - x0) / (x1 - x0)
        table.SetTableValue(i, *[(1 - t) * u + t * v for u, v in zip(a, b)], 1)
    return table


def faces_of(grid, cell):
    """The faces of a cell as lists of point ids."""
    if grid.GetCellType(cell) != VTK_POLYHEDRON:
        return [
            [face.GetPointId(i) for i in range(face.GetNumberOfPoints())]
            for face in map(grid.GetCell(cell).GetFace, range(6))
        ]
    stream = vtkIdList()
    grid.GetFaceStream(cell, stream)
    ids = [stream.GetId(i) for i in range(stream.GetNumberOfIds())]
    at, faces = 1, []
    for _ in range(ids[0]):
        faces.append(ids[at + 1 : at + 1 + ids[at]])
        at += 1 + ids[at]
    return faces


def slice_plane(grid, axis, at):
    """The grid plane nearest to a fraction of the extent: the highest coordinate of some box's corners."""
    low, high = grid.GetBounds()[2 * axis : 2 * axis + 2]
    wanted = low + at * (high - low)
    tops = {grid.GetCell(c).GetBounds()[2 * axis + 1] for c in range(grid.GetNumberOfCells()) if full(grid, c)}
    if not tops:
        sys.exit("no full boxes in the file: write it with cut_grid --full")
    return min(tops, key=lambda top: (abs(top - wanted), top))


def full(grid, cell):
    return grid.GetCellType(cell) != VTK_POLYHEDRON


def polygons(grid, axis, plane):
    """Faces on the plane of cells below it: of cut cells with their volume fraction, and of full boxes."""
    fractions = grid.GetCellData().GetArray("volume_fraction")
    points = grid.GetPoints()
    cut, whole, values = vtkCellArray(), vtkCellArray(), vtkDoubleArray()
    bounds = [0.0] * 6
    for cell in range(grid.GetNumberOfCells()):
        grid.GetCellBounds(cell, bounds)
        if bounds[2 * axis + 1] != plane:
            continue
        for face in faces_of(grid, cell):
            if any(points.GetPoint(v)[axis] != plane for v in face):
                continue
            into = whole if full(grid, cell) else cut
            into.InsertNextCell(len(face))
            for v in face:
                into.InsertCellPoint(v)
            if into is cut:
                values.InsertNextValue(fractions.GetValue(cell))
    return cut, whole, values


def actor(points, cells, values, table):
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    drawn = vtkActor()
    drawn.SetMapper(mapper)
    look = drawn.GetProperty()
    look.LightingOff()
    look.EdgeVisibilityOn()
    look.SetEdgeColor(0.25, 0.27, 0.30)
    look.SetLineWidth(1)
    if values is None:
        mapper.ScalarVisibilityOff()
        look.SetColor(*GREY)
    else:
        data.GetCellData().SetScalars(values)
        mapper.SetScalarModeToUseCellData()
        mapper.SetLookupTable(table)
        mapper.UseLookupTableScalarRangeOn()
    return drawn


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cells")
    parser.add_argument("picture")
    parser.add_argument("--axis", choices="xyz", default="z")
    parser.add_argument("--at", type=float, default=0.5, help="where in the extent, 0 to 1")
    parser.add_argument("--size", type=int, default=1600, help="pixels of the longer side")
    options = parser.parse_args()
    axis = "xyz".index(options.axis)

    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(options.cells)
    reader.Update()
    grid = reader.GetOutput()
    plane = slice_plane(grid, axis, options.at)
    cut, whole, values = polygons(grid, axis, plane)
    if cut.GetNumberOfCells() == 0:
        sys.exit(f"{options.cells}: no cut cell ends at {options.axis} = {plane}")

    table = colours()
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor(grid.GetPoints(), whole, None, table))
    renderer.AddActor(actor(grid.GetPoints(), cut, values, table))
    bar = vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle("volume fraction")
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.2f")
    bar.UnconstrainedFontSizeOn()
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.SetFontSize(options.size // 60)
        text.ShadowOff()
        text.ItalicOff()
        text.BoldOff()
    bar.SetPosition(0.85, 0.25)
    bar.SetWidth(0.1)
    bar.SetHeight(0.5)
    renderer.AddActor(bar)

    # Seen along the axis, the picture filled by what is drawn, with room for the bar.
    used = [v for cells in (cut, whole) for v in ids_of(cells)]
    u, v = [(1, 2), (0, 2), (0, 1)][axis]
    coordinates = [grid.GetPoint(i) for i in used]
    low = [min(c[i] for c in coordinates) for i in (u, v)]
    high = [max(c[i] for c in coordinates) for i in (u, v)]
    width, height = (high[0] - low[0]) * 1.3, (high[1] - low[1]) * 1.05
    centre = [0.0] * 3
    centre[axis] = plane
    centre[u] = low[0] - 0.025 * (high[0] - low[0]) + width / 2
    centre[v] = (low[1] + high[1]) / 2
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    # Looking at y with z up means standing at negative y.
    away = (-1 if axis == 1 else 1) * max(width, height)
    camera.SetPosition(*[c + (away if i == axis else 0) for i, c in enumerate(centre)])
    camera.SetViewUp(*[1.0 if i == v else 0.0 for i in range(3)])
    camera.SetParallelScale(height / 2)
    renderer.ResetCameraClippingRange()

    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*[round(options.size * side / max(width, height)) for side in (width, height)])
    window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    writer = vtkPNGWriter()
    writer.SetFileName(options.picture)
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


def ids_of(cells):
    """All point ids of a cell array."""
    ids = vtkIdList()
    cells.InitTraversal()
    while cells.GetNextCell(ids):
        yield from (ids.GetId(i) for i in range(ids.GetNumberOfIds()))


if __name__ == "__main__":
    main()

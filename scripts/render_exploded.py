#!/usr/bin/python3
"""Renders an exploded view, as `cut_mesh --exploded FILE.vtp` writes it, or a network by patches or regions, as `extract_network --patches
FILE.vtp` and `--exploded FILE.vtp` do, to a PNG.

    render_exploded.py EXPLODED.vtp PICTURE.png [--size 1600] [--azimuth 30] [--elevation 20] [--line 1] [--up y]

One flat colour per cell, red tubes along the lines where planes meet the model (surfaces meet), white background. Draws off screen, but
Debian's VTK still wants an X server: call it as `xvfb-run -a render_exploded.py ...` on a machine without a display.
"""

import argparse
import colorsys
import sys

from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals, vtkTubeFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLight,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)
from vtkmodules.vtkRenderingOpenGL2 import vtkRenderStepsPass, vtkSSAAPass, vtkSSAOPass

RED = (0.85, 0.06, 0.05)


def palette(cells):
    """A colour per cell: hues by the golden ratio, so that neighbouring ids differ; soft, and never the red of the lines."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(max(cells, 1))
    table.SetTableRange(0, max(cells - 1, 1))
    tones = [(0.38, 0.98), (0.46, 0.92), (0.30, 0.96)]
    for cell in range(cells):
        hue = 0.07 + 0.83 * ((0.57 + cell * 0.6180339887498949) % 1.0)
        saturation, value = tones[cell % 3]
        table.SetTableValue(cell, *colorsys.hsv_to_rgb(hue, saturation, value), 1.0)
    return table


def part(data, lines):
    """Only the lines, or only the polygons with their cell data (lines come first in VTK's cell data)."""
    out = vtkPolyData()
    out.SetPoints(data.GetPoints())
    if lines:
        out.SetLines(data.GetLines())
        return out
    out.SetPolys(data.GetPolys())
    cells = data.GetCellData().GetArray("cell")
    kept = cells.NewInstance()
    kept.SetName("cell")
    count = data.GetNumberOfPolys()
    kept.SetNumberOfTuples(count)
    kept.InsertTuples(0, count, data.GetNumberOfLines(), cells)
    out.GetCellData().SetScalars(kept)
    return out


def light(renderer, azimuth, elevation, intensity):
    """A light that moves with the camera, `azimuth` degrees to the right of the viewer and `elevation` above."""
    lamp = vtkLight()
    lamp.SetLightTypeToCameraLight()
    lamp.SetDirectionAngle(elevation, azimuth)
    lamp.SetIntensity(intensity)
    renderer.AddLight(lamp)


def extent(camera, points, aspect):
    """Lowest and highest x and y of the points in the picture, which runs from -1 to 1 both ways."""
    matrix = camera.GetCompositeProjectionTransformMatrix(aspect, -1, 1)
    low, high = [float("inf")] * 2, [float("-inf")] * 2
    for i in range(points.GetNumberOfPoints()):
        x, y, _, w = matrix.MultiplyPoint((*points.GetPoint(i), 1.0))
        for k, c in enumerate((x / w, y / w)):
            low[k], high[k] = min(low[k], c), max(high[k], c)
    return low, high


def fill_frame(window, camera, points, longest, margin=0.025):
    """Gives the window the drawing's proportions, its longer side `longest` pixels, and zooms and shifts the camera until
    the drawing fills it up to the margin: what ResetCamera leaves around the bounding sphere is more than a picture wants."""
    low, high = extent(camera, points, 1.0)
    width, height = high[0] - low[0], high[1] - low[1]
    size = [round(longest * side / max(width, height)) for side in (width, height)]
    window.SetSize(*size)
    low, high = extent(camera, points, size[0] / size[1])
    zoom = (2 - 2 * margin) / max(high[0] - low[0], high[1] - low[1])
    camera.Zoom(zoom)
    camera.SetWindowCenter(*[zoom * (a + b) / 2 for a, b in zip(low, high)])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("exploded")
    parser.add_argument("picture")
    parser.add_argument("--size", type=int, default=1600, help="pixels of the longer side")
    parser.add_argument("--azimuth", type=float, default=30)
    parser.add_argument("--elevation", type=float, default=20)
    parser.add_argument("--line", type=float, default=1, help="thickness of lines")
    parser.add_argument("--up", choices="xyz", default="y")
    options = parser.parse_args()

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(options.exploded)
    reader.Update()
    data = reader.GetOutput()
    if data.GetNumberOfPolys() == 0:
        sys.exit(f"{options.exploded}: no polygons in it")
    cells = int(data.GetCellData().GetArray("cell").GetRange()[1]) + 1
    size = data.GetLength()

    # Smooth over the scan's facets, sharp where a plane cut: points are split where the angle says so.
    normals = vtkPolyDataNormals()
    normals.SetInputData(part(data, lines=False))
    normals.SetFeatureAngle(35)
    normals.SplittingOn()
    normals.ConsistencyOff()
    faces = vtkPolyDataMapper()
    faces.SetInputConnection(normals.GetOutputPort())
    faces.SetScalarModeToUseCellData()
    faces.SetLookupTable(palette(cells))
    faces.UseLookupTableScalarRangeOn()
    solid = vtkActor()
    solid.SetMapper(faces)
    solid.GetProperty().SetAmbient(0.40)
    solid.GetProperty().SetDiffuse(0.66)
    solid.GetProperty().SetSpecular(0.10)
    solid.GetProperty().SetSpecularPower(25)

    tubes = vtkTubeFilter()
    tubes.SetInputData(part(data, lines=True))
    tubes.SetRadius(size * 0.0011 * options.line)
    tubes.SetNumberOfSides(8)
    tubes.CappingOn()
    curves = vtkPolyDataMapper()
    curves.SetInputConnection(tubes.GetOutputPort())
    curves.ScalarVisibilityOff()
    red = vtkActor()
    red.SetMapper(curves)
    red.GetProperty().SetColor(*RED)
    red.GetProperty().SetAmbient(0.55)
    red.GetProperty().SetDiffuse(0.5)

    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AutomaticLightCreationOff()
    light(renderer, -25, 30, 0.75)  # key
    light(renderer, 55, 5, 0.45)  # fill
    light(renderer, 0, 75, 0.25)  # from above
    renderer.AddActor(solid)
    renderer.AddActor(red)

    # Shade what lies in the gaps between cells; then draw at twice the resolution and average.
    steps = vtkRenderStepsPass()
    occlusion = vtkSSAOPass()
    occlusion.SetRadius(0.05 * size)
    occlusion.SetBias(0.002 * size)
    occlusion.SetKernelSize(96)
    occlusion.BlurOn()
    occlusion.SetDelegatePass(steps)
    smooth = vtkSSAAPass()
    smooth.SetDelegatePass(occlusion)
    renderer.SetPass(smooth)

    camera = renderer.GetActiveCamera()
    centre = data.GetCenter()
    camera.SetFocalPoint(*centre)
    view, up = {"x": ((0, 1, 0), (1, 0, 0)), "y": ((0, 0, 1), (0, 1, 0)), "z": ((0, -1, 0), (0, 0, 1))}[options.up]
    camera.SetPosition(*[c + 4 * size * v for c, v in zip(centre, view)])
    camera.SetViewUp(*up)
    camera.Azimuth(options.azimuth)
    camera.Elevation(options.elevation)
    camera.SetViewAngle(20)
    renderer.ResetCamera()

    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.AddRenderer(renderer)
    fill_frame(window, camera, data.GetPoints(), options.size)
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


if __name__ == "__main__":
    main()

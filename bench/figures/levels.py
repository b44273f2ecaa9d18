#!/usr/bin/python3
"""Draws mean curvature on some levels of a dataset side by side, as bench/figures/levels.png is.

  bench/figures/levels.py demo/archive/scans/armadillo.off.vtkhdf levels.png --turn 180

Blue is convex, red concave, white flat; all levels share one scale. Needs Debian's python3-vtk9.
"""
import argparse

import h5py
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

PANEL = (216, 250)


def level_mesh(level):
    triangles = level["triangles"][:]
    cells = np.column_stack([np.full(len(triangles), 3), triangles]).ravel()
    array = vtk.vtkCellArray()
    array.SetCells(len(triangles), numpy_to_vtkIdTypeArray(cells, deep=True))
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(level["points"][:], deep=True))
    mesh = vtk.vtkPolyData()
    mesh.SetPoints(points)
    mesh.SetPolys(array)
    mesh.GetPointData().SetScalars(numpy_to_vtk(level["mean_curvature"][:], deep=True))
    mesh.GetPointData().SetNormals(numpy_to_vtk(level["normals"][:], deep=True))
    return mesh


def renderer(level, limit, panel, options):
    colours = vtk.vtkColorTransferFunction()
    colours.SetColorSpaceToDiverging()
    colours.AddRGBPoint(-limit, 0.12, 0.29, 0.66)
    colours.AddRGBPoint(limit, 0.71, 0.08, 0.12)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(level_mesh(level))
    mapper.SetLookupTable(colours)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetInterpolationToPhong()
    actor.GetProperty().SetAmbient(0.25)
    view = vtk.vtkRenderer()
    view.AddActor(actor)
    view.SetBackground(1, 1, 1)
    view.SetViewport(*panel)
    label = vtk.vtkTextActor()
    label.SetInput(f"level {level.attrs['iteration']}, sigma {level.attrs['scale']:.3g}")
    label.GetTextProperty().SetColor(0, 0, 0)
    label.GetTextProperty().SetFontSize(13)
    label.SetPosition(50, 5)
    view.AddActor2D(label)
    view.ResetCamera()
    camera = view.GetActiveCamera()
    camera.Azimuth(options.turn)
    camera.Elevation(options.tilt)
    camera.OrthogonalizeViewUp()
    view.ResetCamera()
    camera.Zoom(1.25)
    camera.SetWindowCenter(0, -0.05)  # room for the label
    view.ResetCameraClippingRange()
    return view


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset")
    parser.add_argument("png")
    parser.add_argument("--levels", type=int, nargs="+", default=[0, 2, 4, 8])
    parser.add_argument("--turn", type=float, default=0, help="degrees about the vertical axis")
    parser.add_argument("--tilt", type=float, default=0, help="degrees upwards")
    options = parser.parse_args()

    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    count = len(options.levels)
    window.SetSize(count * PANEL[0], PANEL[1])
    with h5py.File(options.dataset) as file:
        middle = file["levels"][f"{options.levels[1 % count]:03}"]["mean_curvature"][:]
        limit = float(np.percentile(np.abs(middle), 95))
        for i, k in enumerate(options.levels):
            panel = (i / count, 0, (i + 1) / count, 1)
            window.AddRenderer(renderer(file["levels"][f"{k:03}"], limit, panel, options))
        window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(options.png)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()

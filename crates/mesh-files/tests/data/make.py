"""Writes the files beside it by the programs that users have: VTK and SimpleITK.

    pip install vtk SimpleITK && python make.py

Two lines, of four points and of three, on (k, k * k / 4, 1 - k / 2) and moved by (0, 0, 8); a ball of label 3 in voxels of
1, 1.5 and 2 mm, turned by 30 degrees about z.
"""

from pathlib import Path

import numpy as np
import SimpleITK as sitk
import vtk

here = Path(__file__).parent


def lines():
    points, cells = vtk.vtkPoints(), vtk.vtkCellArray()
    points.SetDataTypeToDouble()
    for count, shift in [(4, 0.0), (3, 8.0)]:
        cell = vtk.vtkIdList()
        for k in range(count):
            cell.InsertNextId(points.InsertNextPoint(k, k * k / 4, 1 - k / 2 + shift))
        cells.InsertNextCell(cell)
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetLines(cells)
    radius = vtk.vtkDoubleArray()
    radius.SetName("MaximumInscribedSphereRadius")
    for k in range(points.GetNumberOfPoints()):
        radius.InsertNextValue(3.0 + k)
    data.GetPointData().AddArray(radius)
    return data


for version, name in [(42, "4"), (51, "5")]:
    for kind in ["ascii", "binary"]:
        writer = vtk.vtkPolyDataWriter()
        writer.SetFileVersion(version)
        writer.SetFileTypeToASCII() if kind == "ascii" else writer.SetFileTypeToBinary()
        writer.SetInputData(lines())
        writer.SetFileName(str(here / f"lines_{name}_{kind}.vtk"))
        writer.Write()
for name, mode, packed, encoded in [
    ("ascii", "Ascii", False, False),
    ("binary", "Binary", False, False),
    ("binary_packed", "Binary", True, False),
    ("appended", "Appended", False, False),
    ("appended_packed", "Appended", True, False),
    ("appended_packed_base64", "Appended", True, True),
]:
    writer = vtk.vtkXMLPolyDataWriter()
    getattr(writer, f"SetDataModeTo{mode}")()
    writer.SetCompressorTypeToZLib() if packed else writer.SetCompressorTypeToNone()
    writer.SetEncodeAppendedData(encoded)
    writer.SetInputData(lines())
    writer.SetFileName(str(here / f"lines_{name}.vtp"))
    writer.Write()

size, spacing, radius = (16, 12, 10), (1.0, 1.5, 2.0), 6.0
cos, sin = np.cos(np.pi / 6), np.sin(np.pi / 6)
direction = [cos, -sin, 0, sin, cos, 0, 0, 0, 1]
image = sitk.Image(size, sitk.sitkUInt8)
image.SetSpacing(spacing)
image.SetOrigin((-20, 5, 3))
image.SetDirection(direction)
centre = np.array(image.TransformContinuousIndexToPhysicalPoint((7.5, 5.5, 4.5)))
print("the ball's centre:", centre)
for index in np.ndindex(*size):
    place = np.array(image.TransformIndexToPhysicalPoint([int(k) for k in index]))
    if np.linalg.norm(place - centre) < radius:
        image[[int(k) for k in index]] = 3
sitk.WriteImage(image, str(here / "ball.mha"), useCompression=True)
sitk.WriteImage(image, str(here / "ball.mhd"), useCompression=False)

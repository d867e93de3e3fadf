"""Reads a springs file with VTK's own reader and prints every line cell, for tests/io/vtk.c.

usage: vtk_read.py FILE.vtp|FILE.vtu; exit code 77 when VTK is not installed.
"""
import sys

try:
    import vtk
except ImportError:
    sys.exit(77)

reader = vtk.vtkXMLPolyDataReader() if sys.argv[1].endswith(".vtp") else vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
names = ["stiffness", "coupling", "direction", "dual", "cond", "element", "class", "form", "spring", "couples_to"]
tag = grid.GetPointData().GetArray("tag")
field = grid.GetFieldData()
print("points", grid.GetNumberOfPoints(), "cells", grid.GetNumberOfCells())
for name in ("class names", "form names"):
    array = field.GetAbstractArray(name)
    print(name, *(array.GetValue(i) for i in range(array.GetNumberOfValues())))
for n in range(grid.GetNumberOfPoints()):
    print("point", int(tag.GetValue(n)), *("%.17g" % c for c in grid.GetPoint(n)))
for c in range(grid.GetNumberOfCells()):
    cell = grid.GetCell(c)
    values = [cell.GetCellType(), cell.GetNumberOfPoints(), cell.GetPointId(0), cell.GetPointId(1)]
    for name in names:
        array = grid.GetCellData().GetArray(name)
        values += array.GetTuple(c)
    print("cell", *("%.17g" % v for v in values))

"""Reads a data set with VTK's own reader and prints everything in it, for tests/io/frames.c.

usage: frames_read.py FILE.pvd; exit code 77 when VTK is not installed.
"""
import os
import sys
import xml.etree.ElementTree

try:
    import vtk
except ImportError:
    sys.exit(77)


def show(attributes, where):
    for i in range(attributes.GetNumberOfArrays()):
        array = attributes.GetArray(i)
        print(where, array.GetName(), array.GetDataTypeAsString(), array.GetNumberOfComponents(),
              array.GetNumberOfTuples())
        for t in range(array.GetNumberOfTuples()):
            print(*("%.17g" % v for v in array.GetTuple(t)))


for entry in xml.etree.ElementTree.parse(sys.argv[1]).getroot().find("Collection"):
    print("frame", entry.get("file"), entry.get("timestep"))
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(os.path.join(os.path.dirname(sys.argv[1]), entry.get("file")))
    reader.Update()
    grid = reader.GetOutput()
    for i in range(grid.GetFieldData().GetNumberOfArrays()):
        array = grid.GetFieldData().GetAbstractArray(i)
        print("field", array.GetName(), *(array.GetValue(v) for v in range(array.GetNumberOfValues())), sep="|")
    print("points", grid.GetNumberOfPoints())
    for n in range(grid.GetNumberOfPoints()):
        print(*("%.17g" % c for c in grid.GetPoint(n)))
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        print("cell", cell.GetCellType(), *(cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())))
    show(grid.GetPointData(), "point")
    show(grid.GetCellData(), "cells")

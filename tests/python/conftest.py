"""Meshes, settings and the results of the C++ interface for the tests of the Python module."""
import os
import subprocess

import numpy
import pytest

import drape


class Reference:
    """Files of drape_python_reference as arrays."""

    def __init__(self, folder):
        self.folder = folder

    def array(self, name, dtype, *shape):
        return numpy.fromfile(self.folder / name, dtype).reshape(*shape)

    def mesh(self, name):
        return drape.Mesh(self.array(name + ".positions", numpy.float32, -1, 3),
                          self.array(name + ".triangles", numpy.int32, -1, 3))


@pytest.fixture(scope="session")
def reference(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reference")
    subprocess.run([os.environ["DRAPE_PYTHON_REFERENCE"], folder], check=True)
    return Reference(folder)


@pytest.fixture(scope="session")
def host():
    return drape.Settings(backend="host", threads=2)


@pytest.fixture(scope="session")
def make_sheet():
    """Returns a function that makes a square of nodes x nodes, facing up."""
    def make(nodes, size, height):
        along = numpy.linspace(-size / 2, size / 2, nodes, dtype=numpy.float32)
        x, z = numpy.meshgrid(along, along)
        positions = numpy.stack([x.ravel(), numpy.full(nodes * nodes, height, numpy.float32), z.ravel()], 1)
        corner = (numpy.arange(nodes - 1)[:, None] * nodes + numpy.arange(nodes - 1)).ravel()
        quads = numpy.stack([corner, corner + nodes, corner + 1, corner + 1, corner + nodes, corner + nodes + 1], 1)
        return drape.Mesh(positions, quads.reshape(-1, 3).astype(numpy.int32))
    return make


@pytest.fixture(scope="session")
def sheet(make_sheet):
    return make_sheet(9, 0.8, 0.3)


@pytest.fixture(scope="session")
def plate():
    return drape.Mesh(numpy.array([[-3, 0, -3], [3, 0, -3], [3, 0, 3], [-3, 0, 3]], numpy.float32),
                      numpy.array([[0, 2, 1], [0, 3, 2]], numpy.int32))

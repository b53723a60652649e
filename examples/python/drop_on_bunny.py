#!/usr/bin/env python3
"""Drops a cloth on the Stanford bunny and prints what it touched.

Usage: drop_on_bunny.py [--obstacle FILE.obj] [--nodes N] [--steps N] [--backend auto|opencl|host] [--output FILE.npy]

PYTHONPATH must name the folder of the package drape: build/release/python, or that of the installation.
"""
import argparse
import sys

import numpy

import drape

BUNNY = "/usr/share/glmark2/models/bunny.obj"  # Debian's glmark2-data


def read_obj(path, size):
    """Returns the triangles of an OBJ file, scaled to that size (m), standing on y = 0."""
    positions, triangles = [], []
    with open(path) as file:
        for line in file:
            words = line.split()
            if words[:1] == ["v"]:
                positions.append([float(word) for word in words[1:4]])
            elif words[:1] == ["f"]:
                corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
                triangles += [[corners[0], corners[i], corners[i + 1]] for i in range(1, len(corners) - 1)]
    positions = numpy.array(positions)
    low, high = positions.min(0), positions.max(0)
    positions = (positions - (low + high) / 2) * size / (high - low).max()
    positions[:, 1] -= positions[:, 1].min()
    return positions.astype(numpy.float32), numpy.array(triangles, numpy.int32)


def make_sheet(nodes, size, height):
    """Returns a horizontal square of nodes x nodes and its triangles."""
    along = numpy.linspace(-size / 2, size / 2, nodes)
    x, z = numpy.meshgrid(along, along)
    positions = numpy.stack([x.ravel(), numpy.full(nodes * nodes, height), z.ravel()], 1).astype(numpy.float32)
    corner = (numpy.arange(nodes - 1)[:, None] * nodes + numpy.arange(nodes - 1)).ravel()
    quads = numpy.stack([corner, corner + nodes, corner + 1, corner + 1, corner + nodes, corner + nodes + 1], 1)
    return positions, quads.reshape(-1, 3).astype(numpy.int32)


def main():
    parser = argparse.ArgumentParser(description="Drops a cloth on a mesh and prints what it touched.")
    parser.add_argument("--obstacle", default=BUNNY, help="OBJ file, the Stanford bunny by default")
    parser.add_argument("--nodes", type=int, default=33, help="nodes along a side of the cloth")
    parser.add_argument("--steps", type=int, default=240, help="steps of 1/60 s")
    parser.add_argument("--backend", default="auto", help="auto, opencl or host")
    parser.add_argument("--output", help="file for the positions of every step, as a NumPy array")
    arguments = parser.parse_args()

    vertices, triangles = read_obj(arguments.obstacle, 2)
    world = drape.ClothWorld(drape.Settings(backend=arguments.backend))
    bunny = world.add_mesh(vertices, triangles)
    cloth = world.add_cloth(*make_sheet(arguments.nodes, 2.4, float(vertices[:, 1].max()) + 0.1))
    positions = world.positions(cloth)  # follows the steps
    frames = []
    for step in range(1, arguments.steps + 1):
        status = world.step(1 / 60)
        if status:
            print(f"step {step}: {drape.status_text(status)}")
        if arguments.output:
            frames.append(positions.copy())
        if step % 60 == 0:
            contacts = world.contacts()
            nodes = numpy.unique(contacts["nodes"][contacts["nodes"] >= 0])
            print(f"{step / 60:.0f} s: {len(nodes)} of {len(positions)} nodes touch mesh {bunny}"
                  + (f" between heights {contacts['point'][:, 1].min():.2f} and {contacts['point'][:, 1].max():.2f} m"
                     if len(contacts) else ""))
    if arguments.output:
        numpy.save(arguments.output, numpy.array(frames))
    print(world.report())

    # Asks independently of the world.
    found = drape.Queries(drape.Settings(backend=arguments.backend)).mesh_pairs(
        drape.Mesh(positions.astype(numpy.float32), make_sheet(arguments.nodes, 1, 0)[1]),
        drape.Mesh(vertices, triangles))
    print(f"{found.intersecting_count} pairs of triangles intersect")
    return 0 if found.intersecting_count == 0 else 1


if __name__ == "__main__":
    sys.exit(main())

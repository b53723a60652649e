"""Drape: cloth against triangle meshes, itself and other cloth, and collision queries, on NumPy arrays.

ClothWorld steps cloths over obstacles. Queries answers questions about meshes without a world. Both run on an OpenCL
device or on the host, with the same answers.

Lengths are metres, times seconds, masses kilograms. Arrays of points are float32 with x, y and z in each row; arrays
of indices are int32. Lists and tuples of numbers are converted; an array of another type raises TypeError, an array of
another shape ValueError. Invalid values raise ValueError, a missing or failed device DeviceError, and a lack of memory
MemoryError.

Threads may share an object: its calls wait for each other, and other Python threads run meanwhile. A process that
fork() makes must not use objects of its parent: start processes with the method "spawn".
"""
from ._drape import DeviceError
from ._drape import VERSION as __version__
from .queries import (EDGES, VERTEX_FACE, CcdSettings, Mesh, MeshMotion, MeshPairs, Motions, QueryLimits, Queries)
from .settings import (Settings, StepStatus, list_devices, log_to_standard_error, status_text, why_no_device)
from .world import ClothWorld

__all__ = [
    "EDGES", "VERTEX_FACE", "CcdSettings", "ClothWorld", "DeviceError", "Mesh", "MeshMotion", "MeshPairs", "Motions",
    "Queries", "QueryLimits", "Settings", "StepStatus", "list_devices", "log_to_standard_error", "status_text",
    "why_no_device"
]

DeviceError.__module__ = "drape"
DeviceError.__doc__ = "The requested OpenCL device is missing, unusable, or failed. Holds the device's whole log."

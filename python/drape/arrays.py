"""Checks of the arrays that a caller passes."""
from __future__ import annotations

from typing import Any, List, Optional, Sequence, Union

import numpy
import numpy.typing

#: An array that Drape returns; each function says of which type and shape.
Array = numpy.typing.NDArray[Any]
#: Arrays of float32 or int32, or sequences of numbers that become such arrays.
Floats = Union[numpy.typing.NDArray[numpy.float32], Sequence[Any]]
Indices = Union[numpy.typing.NDArray[numpy.int32], Sequence[Any]]


def shape_text(shape: Sequence[Optional[int]]) -> str:
    """Returns a shape in words, n for any length."""
    parts = ["n" if length is None else str(length) for length in shape]
    return "(" + ", ".join(parts) + ("," if len(parts) == 1 else "") + ")"


def array_of(values: Any, kinds: str, type_: type, name: str) -> Array:
    """Returns the values as an array of that type. Refuses arrays of other types, and numbers of other kinds."""
    if isinstance(values, numpy.ndarray):
        if values.dtype != type_:
            wanted = numpy.dtype(type_).name
            raise TypeError(f"{name}: {wanted} expected, not {values.dtype}; convert with astype(numpy.{wanted})")
        return values
    try:
        given = numpy.asarray(values)
    except ValueError:
        raise ValueError(f"{name}: rows of different lengths") from None
    if given.size > 0 and given.dtype.kind not in kinds:
        raise TypeError(f"{name}: {numpy.dtype(type_).name} expected, not {given.dtype}")
    if kinds == "iu" and given.size > 0 and (given.max() > 2**31 - 1 or given.min() < -2**31):
        raise ValueError(f"{name}: an index is beyond int32")
    return given.astype(type_)


def checked(array: Array, shape: Sequence[Optional[int]], name: str) -> Array:
    """Returns the array in C order. Refuses other shapes; None in a shape stands for any length."""
    if array.size == 0 and shape[0] in (None, 0):
        array = array.reshape([0] + [length or 0 for length in shape[1:]])
    if len(array.shape) != len(shape) or any(want not in (None, got) for want, got in zip(shape, array.shape)):
        raise ValueError(f"{name}: shape {shape_text(shape)} expected, not {array.shape}")
    return numpy.ascontiguousarray(array)


def floats(values: Floats, shape: Sequence[Optional[int]], name: str) -> Array:
    """Returns a float32 array of that shape."""
    return checked(array_of(values, "fiu", numpy.float32, name), shape, name)


def indices(values: Indices, shape: Sequence[Optional[int]], name: str) -> Array:
    """Returns an int32 array of that shape."""
    return checked(array_of(values, "iu", numpy.int32, name), shape, name)


def numbers(values: Sequence[float], count: int, name: str) -> List[float]:
    """Returns so many Python floats, of a sequence or an array of any type."""
    found = [float(value) for value in values]
    if len(found) != count:
        raise ValueError(f"{name}: {count} numbers expected, not {len(found)}")
    return found

"""Settings of worlds and queries, the status of a step, and the devices there are."""
from __future__ import annotations

import dataclasses
import enum
from typing import Any, Callable, Dict, List, Optional

from . import _drape


def log_to_standard_error(line: str) -> None:
    """Writes "drape: ", the line and a line feed to standard error."""
    _drape.log_to_standard_error(line)


@dataclasses.dataclass
class Settings:
    """Choices before Drape starts. docs/settings.md says what to change, and why.

    backend: "auto", "opencl", "host" or "by_cost".
    device: part of an OpenCL device's or platform's name, or "host"; "" means the environment variable DRAPE_DEVICE.
    crossover: expected triangle pairs from which the device is used; 0 always, infinity never, negative: measured.
    activation: reach of contacts beyond the thickness, as a fraction of it, 0 to 4.
    mode: "discrete", "continuous" or "automatic", the treatment of motion within a step.
    solver: "auto", "drape" or "bullet", which solves the links.
    solver_place: "auto", "host" or "device", where Drape's solver computes.
    dynamic_convex: "drape" or "bullet", which finds contacts with convex shapes of dynamic bodies.
    static_convex: the same for convex shapes of static and kinematic bodies.
    surfaces: the same for planes and height fields.
    cloth_sleeps: lets cloth at rest fall asleep.
    threads: number of threads, 0 to 64; 0 means the available cores, 8 at most.
    candidate_limit: largest number of candidates in a step or query.
    contact_limit: largest number of contacts in a step, or of answers of a query.
    profile_kernels: makes the device time every kernel launch.
    cache_folder: folder for compiled kernels; "none" for no cache, "" for the user's.
    log: receives one line about a problem of a world, on the thread that steps it. It must not call that world. None
        for nobody. Lines name cloths and obstacles by their indices.
    """
    backend: str = "auto"
    device: str = ""
    crossover: float = -1.0
    activation: float = 0.5
    mode: str = "automatic"
    solver: str = "auto"
    solver_place: str = "auto"
    dynamic_convex: str = "drape"
    static_convex: str = "drape"
    surfaces: str = "drape"
    cloth_sleeps: bool = False
    threads: int = 0
    candidate_limit: int = 2**27
    contact_limit: int = 2**24
    profile_kernels: bool = False
    cache_folder: str = ""
    log: Optional[Callable[[str], None]] = log_to_standard_error

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in type(self).__dataclass_fields__:
            raise AttributeError(f"Settings has no field {name!r}")
        super().__setattr__(name, value)

    def _for_binding(self) -> Dict[str, Any]:
        """Returns the fields with numbers for choices. Raises ValueError for an unknown choice."""
        fields = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        for name, numbers in _drape.choices().items():
            if fields[name] not in numbers:
                known = ", ".join(f'"{choice}"' for choice in numbers)
                raise ValueError(f"Settings.{name} is {fields[name]!r}; it should be one of {known}")
            fields[name] = numbers[fields[name]]
        if self.log is not None and not callable(self.log):
            raise TypeError("Settings.log should be a function or None")
        return fields


def binding_of(settings: Optional[Settings]) -> Dict[str, Any]:
    """Returns the fields of the settings, by default those of Settings(), for the binding. Raises TypeError."""
    if settings is None:
        settings = Settings()
    if not isinstance(settings, Settings):
        raise TypeError(f"settings should be a drape.Settings, such as Settings(backend=\"host\"), not {settings!r}")
    return settings._for_binding()


class StepStatus(enum.IntFlag):
    """Problems of a step. docs/using.md says what to do about each."""
    GOOD = 0
    INVALID_NODES = 1
    DEVICE_FAILED = 2
    DEVICE_FULL = 4
    CLOTHS_LEFT_OUT = 8
    COARSE_POSITIONS = 16
    STARTS_INTERSECTING = 32
    FACES_LEFT_OUT = 64
    SURFACE_PASSED = 128
    MOTION_HELD_BACK = 256
    OUT_OF_MEMORY = 512
    CLOTHS_MEET = 1024


def status_text(status: int) -> str:
    """Returns the bits of a StepStatus in words, "" for a good step."""
    return _drape.status_text(int(status))


def list_devices() -> List[Dict[str, Any]]:
    """Returns every OpenCL device in Drape's order of preference: platform, name, driver, is_gpu."""
    return _drape.list_devices()


def why_no_device(settings: Optional[Settings] = None) -> str:
    """Returns "" if the device is available that the settings request, otherwise the reason in one line."""
    return _drape.why_no_device(binding_of(settings))

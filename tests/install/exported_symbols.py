#!/usr/bin/env python3
"""Fails if a shared library exports more than its public interface: exported_symbols.py KIND LIBRARY

KIND is library, recorder or python. Reads the dynamic symbol table with nm. Every exported name must be on the list of
public names, and every public class and function must be exported.
"""
import re
import subprocess
import sys

CLASSES = {
    "library": ["ClothWorld", "CollisionConfiguration", "Plugin", "Queries", "SoftBodySolver"],
    "recorder": ["Recorder"],
    "python": [],
}
FUNCTIONS = {
    "library": ["debugDraw", "defaultCcdSettings", "defaultCloth", "defaultObstacle", "install", "libraryVersion",
                "libraryVersionNumber", "listDevices", "logToStandardError", "statusText", "uninstall",
                "whyNoDevice"],
    "recorder": ["writeGltf", "writePointCaches", "writeReplay"],
    "python": [],
}
PRECISION = r"drape::drapeIsBuiltForBulletIn(Single|Double)Precision"
PLAIN = {"library": r"drape[A-Z]\w*", "recorder": None, "python": r"PyInit_\w+"}


def exported(library):
    """Returns the demangled names of the symbols that a library defines for others."""
    lines = subprocess.run(["nm", "-D", "-C", "--defined-only", library], check=True, text=True,
                           stdout=subprocess.PIPE).stdout.splitlines()
    return [line.split(maxsplit=2)[2] for line in lines if len(line.split(maxsplit=2)) == 3]


def patterns(kind):
    """Returns the regular expressions of public names, each with the name that it stands for."""
    member = r"(::(~?\w+|operator=)(\[abi:\w+\])?\(.*\)( const)?)"
    tables = "vtable for |typeinfo for |typeinfo name for "
    found = [(name, re.compile(rf"drape::{name}{member}|({tables})drape::{name}|(\S+ )?thunk to drape::{name}{member}"))
             for name in CLASSES[kind]]
    found += [(name, re.compile(rf"drape::{name}(\[abi:\w+\])?\(.*\)")) for name in FUNCTIONS[kind]]
    if kind != "python":
        found.append(("the precision of Bullet", re.compile(PRECISION)))
    if PLAIN[kind]:
        found.append((PLAIN[kind], re.compile(PLAIN[kind])))
    return found


def main():
    kind, library = sys.argv[1:]
    names = exported(library)
    public = patterns(kind)
    foreign = [name for name in names if not any(pattern.fullmatch(name) for _, pattern in public)]
    missing = [stands for stands, pattern in public if not any(pattern.fullmatch(name) for name in names)]
    for name in foreign:
        print(f"exported, but not public: {name}")
    for stands in missing:
        print(f"public, but not exported: {stands}")
    print(f"{library}: {len(names)} symbols")
    return 1 if foreign or missing else 0


if __name__ == "__main__":
    sys.exit(main())

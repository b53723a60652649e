"""Describes the machine that figures were measured on, as the benchmark programs do."""
import datetime
import hashlib
import os
import re
import subprocess


def devices(program):
    """Name and driver of every OpenCL device, as PROGRAM --list-devices has them."""
    text = subprocess.run([program, "--list-devices"], check=True, capture_output=True, text=True).stdout
    found = (re.fullmatch(r"(.*) \((.*), driver (.*?)(, GPU)?\)", line) for line in text.splitlines())
    return [{"device": match[1], "driver": match[3]} for match in found if match]


def processor():
    with open("/proc/cpuinfo") as file:
        names = [line.partition(": ")[2].strip() for line in file if line.startswith("model name")]
    return names[0] if names else "unknown"


def describe(program, commit):
    return {"date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d"), "commit": commit,
            "processor": processor(), "cores": os.cpu_count(), "devices": devices(program)}


def scene(obstacle, options):
    """Returns the obstacle, a file's by its hash, and the options of every run."""
    digest = obstacle
    if os.path.isfile(obstacle):
        with open(obstacle, "rb") as file:
            digest = hashlib.sha256(file.read()).hexdigest()[:16]
    return {"obstacle": os.path.basename(obstacle), "obstacle_digest": digest, "options": list(options)}

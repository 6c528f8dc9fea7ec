"""CalculiX beside our own runs of a study: the same meshes, its own input file, its answer and its time.

Its seconds are those of its whole process, input and output included; ours begin when the deck is read.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from zrno.pipelines import options as command_options
from zrno.pipelines import scene as scenes
from zrno.pipelines.convert import read_source
from zrno.pipelines.manifest import plain
from zrno.pipelines.measures import in_plane, nearest
from zrno.pipelines.reference import error
from zrno.pipelines.signals import Unmeasured
from zrno.pipelines.study_plan import Plan, run_name
from zrno.pipelines.study_runs import STAMP
from zrno.translators.calculix import of_type, write_mesh
from zrno.translators.model import Ints, Model
from zrno.translators.text import InputError, write_atomically

PROGRAM = "ccx"
MESH = "mesh.inp"  # what the user's input file includes
LONGEST = 1800.0  # seconds of a run
_NUMBER = r"[-+]?\d+\.\d+(?:E[-+]?\d+)?"


def compare(
    plan: Plan, directory: Path, *, repeat: int, threads: int | None, allow_outside: bool, progress: bool
) -> tuple[list[dict[str, Any]], str]:
    """Rows of the study's peer, a row a mesh and type of elements, and what is to be said of them ("" nothing).

    threads: None for as many as our own runs of the same mesh took.
    """
    peer = plan.study.peer
    if peer is None:
        return [], ""
    if shutil.which(PROGRAM) is None:
        return [], f"CalculiX ({PROGRAM}) is not installed: its points are left out"
    given = (plan.path.parent / peer.ccx).read_bytes()
    rows: list[dict[str, Any]] = []
    for own in _meshes(plan):
        scene = scenes.load(plan.path, command_options.split({**plan.options, **own}).scene)
        mesh = scene.meshes[0]
        models: dict[str, Model] = {}
        ours = threads_of(plan, directory, own)
        for name, more in peer.elements.items():
            numbers = {**mesh.numbers, **(more or {})}
            if repr(numbers) not in models:
                source = plan.path.parent / mesh.source
                models[repr(numbers)] = read_source(source, numbers, allow_outside=allow_outside)
            model = models[repr(numbers)]
            if not of_type(model, name):
                continue
            where = directory / "runs" / f"{PROGRAM}_{name}_{run_name(own)}"
            if progress:
                print(f"[{PROGRAM}] {name} {run_name(own)}", file=sys.stderr)
            rows.append(_row(plan, own, name, where, model, given, repeat, threads or ours))
    return rows, "" if rows else "no mesh of the study is of the peer's types of elements"


def _meshes(plan: Plan) -> list[dict[str, Any]]:
    """The options of the runs that make meshes of their own."""
    found: list[dict[str, Any]] = []
    for chosen in plan.runs.values():
        own = _of_mesh(chosen)
        if own not in found:
            found.append(own)
    return found


def _of_mesh(chosen: Mapping[str, Any]) -> dict[str, Any]:
    """The options of a run that are its mesh's."""
    return {key: value for key, value in chosen.items() if not key.startswith("fem.")}


def threads_of(plan: Plan, directory: Path, own: Mapping[str, Any]) -> int:
    """The most threads that our own runs of a mesh had, by their manifests; 1 where there is none."""
    most = 1
    for name, chosen in plan.runs.items():
        if own == _of_mesh(chosen):
            try:
                run = json.loads((directory / "runs" / name / "run.json").read_text(encoding="utf-8"))
                most = max(most, int(run["threads"]))
            except (OSError, ValueError, KeyError, TypeError):
                continue
    return most


def _row(
    plan: Plan, own: Mapping[str, Any], name: str, where: Path, model: Model, given: bytes, repeat: int, threads: int
) -> dict[str, Any]:
    """A row: what is there from before, of the same inputs, is not run again."""
    where.mkdir(parents=True, exist_ok=True)
    write_mesh(where / MESH, model, name, {"AT": measured_nodes(plan, model)})
    write_atomically(where / "case.inp", [given])
    digest = hashlib.sha256((where / MESH).read_bytes() + given + f"{threads}".encode()).hexdigest()
    stamp = _stamp(where, digest)
    while len(stamp["walls"]) < repeat and not stamp["message"]:
        wall, stamp["message"] = _run(where, threads)
        stamp["walls"].append(wall)
    write_atomically(where / STAMP, [json.dumps(plain(stamp), indent=2).encode(), b"\n"])
    row: dict[str, Any] = {
        "run": where.name, "program": PROGRAM, "element": name, "options": dict(own), "nodes": len(model.xyz),
        "error": None, "value": None, "wall_seconds": statistics.median(stamp["walls"]),
        "repeats": len(stamp["walls"]), "message": stamp["message"], "threads": threads,
    }  # fmt: skip
    if not row["message"]:
        try:
            row["value"] = printed((where / "case.dat").read_text(errors="replace"), str(plan.study.quantity.field))
            row["error"] = error(row["value"], plan.against, plan.study.quantity.norm)
        except (Unmeasured, OSError) as missing:
            row["message"] = str(missing)
    return row


def measured_nodes(plan: Plan, model: Model) -> Ints:
    """The nodes (indices) that the quantity is of."""
    what = plan.study.quantity
    if what.measure == "at":
        assert what.point is not None
        return np.array([nearest(model.xyz, what.point)])
    assert what.axis is not None
    assert what.place is not None
    try:
        return in_plane(model.xyz, what.axis, what.place)
    except ValueError as missing:
        raise InputError([plan.scene.fault(("study", "quantity", "place"), str(missing))]) from missing


def printed(text: str, field: str) -> float:
    """A component's sum over the rows of the last block of the set AT in a `.dat`. Raises Unmeasured without one."""
    kind = "displacements" if field.startswith("displacement") else "force"
    heads = list(re.finditer(rf"^.*{kind}.* for set AT\b.*$", text, re.MULTILINE))
    if not heads:
        raise Unmeasured(f"the input file prints no {kind} of the set AT")
    values: list[float] = []
    for line in text[heads[-1].end() :].lstrip().splitlines():
        numbers = re.findall(_NUMBER, line)
        if len(numbers) != 3:
            break
        values.append(float(numbers["xyz".index(field[-1])]))
    if not values or not math.isfinite(sum(values)):
        raise Unmeasured(f"{PROGRAM} printed no numbers")
    return math.fsum(values)


def _run(where: Path, threads: int) -> tuple[float, str]:
    """Seconds of a run, and what went wrong ("" nothing)."""
    environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "CCX_NPROC_EQUATION_SOLVER": str(threads)}
    (where / "case.dat").unlink(missing_ok=True)
    start = time.perf_counter()
    try:
        done = subprocess.run([PROGRAM, "case"], cwd=where, env=environment, stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=LONGEST, check=False)  # fmt: skip
    except subprocess.TimeoutExpired:
        return time.perf_counter() - start, f"{PROGRAM} took more than {LONGEST:.0f} s"
    wall = time.perf_counter() - start
    said = done.stdout.decode(errors="replace")
    if done.returncode or "*ERROR" in said:
        fault = re.search(r"\*ERROR[^\n]*", said)
        return wall, f"{PROGRAM}: {fault.group() if fault else f'exit code {done.returncode}'}"
    return wall, ""


def _stamp(where: Path, digest: str) -> dict[str, Any]:
    try:
        stamp = json.loads((where / STAMP).read_text(encoding="utf-8"))
        if stamp["key"] == digest and isinstance(stamp["walls"], list) and (where / "case.dat").exists():
            return dict(stamp)
    except (OSError, ValueError, KeyError, TypeError):
        pass
    return {"key": digest, "walls": [], "message": ""}

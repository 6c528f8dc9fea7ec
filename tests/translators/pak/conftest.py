"""Helpers of the tests of PAK's decks."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from zrno.translators.elements import TABLE
from zrno.translators.model import ElementBlock, Material, Model, Part, Section


@pytest.fixture(scope="session")
def strict() -> ModuleType:
    """The reader that shares nothing with the package."""
    spec = importlib.util.spec_from_file_location("strict_pak", Path(__file__).with_name("strict.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["strict_pak"] = module
    spec.loader.exec_module(module)
    return module


CORNERS = {
    "line2": [(0, 0, 0), (1, 0, 0)],
    "tri3": [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
    "quad4": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
    "tet4": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    "pyramid5": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)],
    "wedge6": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)],
    "hex8": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
}


def points_of(kind: str) -> np.ndarray:
    """The nodes of one element in VTK's order: corners, middles of edges, of faces, of all."""
    element = TABLE[kind]
    corners = np.array(next(c for name, c in CORNERS.items() if TABLE[name].shape is element.shape), float)
    points = [corners]
    if element.mid_edges:
        points.append(np.array([(corners[a] + corners[b]) / 2 for a, b in element.shape.edges]))
    if element.mid_faces:
        faces = element.shape.faces or [tuple(range(len(corners)))]
        points.append(np.array([corners[list(face)].mean(axis=0) for face in faces if len(face) == 4]))
    if kind == "hex27":
        points.append(corners.mean(axis=0, keepdims=True))
    return np.concatenate(points)


@pytest.fixture
def mesh() -> Callable[..., Model]:
    """mesh("hex8", "wedge6", ...): a model of elements side by side, each with nodes of its own, of one material."""

    def make(*kinds: str, family: str = "", law: str = "elastic", **parameters: float) -> Model:
        model = Model(title="elements", dimension=3)
        rows, count = [], 0
        for number, kind in enumerate(kinds, 1):
            points = points_of(kind) + np.array([2.0 * number, 0, 0])
            nodes = np.arange(count, count + len(points))[None]
            dimension = TABLE[kind].dimension
            own = family or {3: "solid", 2: "shell", 1: "truss"}[dimension]
            model.blocks.append(ElementBlock(kind, np.array([number]), nodes, np.array([1]), own))
            rows.append(points)
            count += len(points)
        model.xyz = np.concatenate(rows)
        model.node_ids = np.arange(1, count + 1)
        model.parts[1] = Part(1, "body", material=1, section=1)
        model.sections[1] = Section(1, parameters={"thickness": 0.5, "area": 2.0, "iyy": 1.0, "izz": 1.0, "j": 0.5})
        model.materials[1] = Material(1, "steel", law, 7.8, {"E": 200.0, "nu": 0.3, **parameters})
        return model

    return make

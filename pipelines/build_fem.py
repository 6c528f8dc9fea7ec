"""From a finite element deck's model to the solver's problem: names and numbers change hands, nothing is computed."""

from __future__ import annotations

from typing import Any

import numpy as np

from zrno.pipelines.fem_method import Fem
from zrno.pipelines.fem_refusals import axes_of_group, heated, law_of_group, refusals
from zrno.solvers import fem
from zrno.translators.control import FemControl
from zrno.translators.elements import TABLE
from zrno.translators.model import ElementBlock, FaceLoad, Model, NodalLoad, Section
from zrno.translators.text import Fault, InputError

_GEOMETRY = {0: fem.SMALL, 1: fem.SMALL, 2: fem.TOTAL, 3: fem.UPDATED, 4: fem.UPDATED, 5: fem.UPDATED}
_MODES = {"hex8": 12, "quad4": 4}  # enhanced strains where a deck asks for incompatible modes
_FACES = {3: "tri3", 4: "quad4", 6: "tri6", 8: "quad8", 9: "quad9"}


def structure_problem(model: Model, path: str, method: Fem | None = None) -> fem.Problem:
    """The problem that a finite element deck poses. path: of the deck; method: what the scene says beyond it.

    Raises InputError for what the deck asks and this solver does not do.
    """
    control = model.fem_control
    if control is None:
        raise InputError([Fault(path, 1, 1, "not a finite element deck", model.format, "a .dat deck of PAK")])
    method = method or Fem()
    faults = refusals(model, path, method)
    if faults:
        raise InputError(sorted(faults))
    numbers = sorted(model.curves)
    n = len(model.xyz)
    fixed = _fixed(model, control)
    lost = sum(int(fixed[a.nodes, a.dofs - 1].sum()) for a in model.nodal_loads if a.kind == "force" and len(a.nodes))
    if lost:
        warning = f"{path}: {lost} forces or moments on degrees of freedom that are held do nothing"
        model.warnings += [warning] if warning not in model.warnings else []
    if not heated(model) and (cold := sum(len(a.nodes) for a in model.nodal_loads if a.kind == "temperature")):
        warning = f"{path}: {cold} temperatures do nothing: no material expands by them (model 3)"
        model.warnings += [warning] if warning not in model.warnings else []
    elements = tuple(_elements(model, method))
    plain = all(e.geometry == fem.SMALL for e in elements)
    return fem.Problem(
        title=model.title,
        dimension=model.dimension,
        x=model.xyz,
        node_ids=model.node_ids,
        elements=elements,
        fixed=fixed,
        curves=tuple(fem.Curve(*model.curves[k].points.T.copy()) for k in numbers),
        nodal_loads=tuple(_force(load, numbers) for load in model.nodal_loads if load.kind == "force"),
        motions=tuple(_motion(m, numbers) for m in model.nodal_loads if m.kind == "displacement" and not _initial(m)),
        face_loads=tuple(f for load in model.face_loads for f in _face_loads(model, load, numbers, follows=not plain)),
        body_loads=tuple(
            fem.BodyLoad(np.array(b.acceleration), _index(b.curve, numbers), _materials(model, b.parts))
            for b in model.body_loads
        ),
        temperatures=tuple(
            fem.Temperature(load.nodes, load.values, _index(load.curve, numbers))
            for load in model.nodal_loads
            if load.kind == "temperature" and heated(model)
        ),
        relations=tuple(
            fem.Relation(int(e.nodes[0]), int(e.dofs[0]) - 1, e.nodes[1:], e.dofs[1:] - 1,
                         -e.coefficients[1:] / e.coefficients[0])
            for e in model.equations
        ),
        stops=tuple(fem.Stop(s.position, s.normal, s.stiffness) for s in method.stops),
        steps=_steps(control, method),
        iteration=_iteration(control, method),
        path=_path(model, control, method),
        dynamics=_dynamics(control, method),
        modes=control.eigen_count if control.eigenvalues else 0,
        displacement=_initial_values(model, "displacement", n),
        velocity=_velocities(model, n),
        solver=method.solver,
    )  # fmt: skip


def _iatyp(section: Section) -> int:
    return abs(int(section.native.get("IATYP", 0)))


def _steps(control: FemControl, method: Fem) -> tuple[tuple[int, float], ...]:
    periods = tuple(control.periods) or ((1, 1.0),)
    if method.steps is None:
        return periods
    return ((method.steps, sum(count * length for count, length in periods) / method.steps),)


def _elements(model: Model, method: Fem) -> list[fem.Elements]:
    found = []
    for block in model.blocks:
        for part in np.unique(block.part).tolist():
            if block.kind in TABLE and model.parts[part].section is not None:
                found += [_group(model, block, rows, part, method) for rows in _lives(block, block.part == part)]
    return found


def _lives(block: ElementBlock, rows: Any) -> list[Any]:
    """Elements (rows: a mask) by their times of birth and death."""
    times = np.column_stack([block.data.get(name, np.zeros(len(block.ids))) for name in ("birth", "death")])
    own, which = np.unique(times[rows], axis=0, return_inverse=True)
    if len(own) < 2:
        return [rows]
    found = []
    for k in range(len(own)):
        some = np.zeros(len(rows), bool)
        some[np.flatnonzero(rows)[which.ravel() == k]] = True
        found.append(some)
    return found


def _group(model: Model, block: ElementBlock, rows: Any, part: int, method: Fem) -> fem.Elements:
    own = model.parts[part]
    section, material = model.sections[own.section or 0], model.materials[own.material or 0]
    native, parameters = section.native, section.parameters
    data = {name: values[rows] for name, values in block.data.items()}
    family = block.family or section.kind
    enhanced = method.enhanced == "all" or (method.enhanced == "deck" and int(native.get("IALFA", 0)) != -1)
    plastic = _iatyp(section) == 1
    mean = method.dilatation == "mean" or (method.dilatation == "auto" and plastic)
    gauss = tuple(int(native.get(f"NGAUS{axis}", 0)) for axis in "XYZ")
    ids = block.ids[rows]
    solid = family == "solid"
    law = law_of_group(model, material, axes_of_group(section), method)
    thickness = data.get("thickness")
    if thickness is None and "thickness" in parameters:
        thickness = np.full(len(ids), parameters["thickness"])
    nodes = block.nodes[rows]
    if family == "shell" and block.kind in ("quad8", "quad9") and not {*gauss[:2]} <= {0, 3}:
        model.warnings.append(f"{len(ids)} {block.kind} shells: 3 x 3 points in the plane, not NGAUS of the deck")
    if family == "plane":
        nodes = _counter_clockwise(model, block.kind, nodes)
    return fem.Elements(
        kind=block.kind,
        family=family,
        nodes=np.ascontiguousarray(nodes),
        ids=ids,
        material=material.id,
        law=law,
        density=material.density,
        geometry=_GEOMETRY[_iatyp(section)] if method.geometry == "deck" else method.geometry,
        gauss=(gauss if solid else gauss[:2]) if block.kind.startswith(("hex", "quad")) else (),
        modes=_modes(block.kind, int(native.get("IALFA", 0))) if enhanced else 0,
        mean=mean and not enhanced and block.kind in ("hex8", "quad4") and family != "shell",
        plane=section.plane if family == "plane" else "",
        thickness=thickness,
        layers=gauss[2] or 2,
        shear_factor=method.shear_factor or 5.0 / 6.0,
        section={k: v for k, v in parameters.items() if isinstance(v, float)},
        orientation=data.get("orientation"),
        value=data.get("area"),
        birth=data.get("birth"),
        death=data.get("death"),
        expansion=material.parameters.get("expansion", 0.0) if heated(model) else 0.0,
        reference=material.parameters.get("reference_temperature", 0.0),
    )


def _counter_clockwise(model: Model, kind: str, nodes: Any) -> Any:
    """Plane elements whose nodes run clockwise, as meshers make them, turned: a corner, then the others backwards."""
    shape = TABLE[kind].shape
    p = model.xyz[nodes[:, : shape.corners]]
    after = np.roll(p, -1, axis=1)
    turned = (p[:, :, 0] * after[:, :, 1] - p[:, :, 1] * after[:, :, 0]).sum(axis=1) < 0.0
    if not turned.any():
        return nodes
    model.warnings.append(f"{int(turned.sum())} {kind} elements run clockwise: turned")
    k = shape.corners
    order = [0, *range(k - 1, 0, -1)]
    if TABLE[kind].mid_edges:
        order += [*range(2 * k - 1, k - 1, -1)]
    order += range(len(order), nodes.shape[1])
    nodes = nodes.copy()
    nodes[turned] = nodes[turned][:, order]
    return nodes


def _modes(kind: str, asked: int) -> int:
    """Enhanced strains for PAK's incompatible modes: nine are its nine; its 12, 18 and 30 are our twelve."""
    return 9 if kind == "hex8" and asked == 1 else _MODES.get(kind, 0)


def _fixed(model: Model, control: FemControl) -> Any:
    fixed = np.zeros((len(model.xyz), 6), bool) if model.fixed is None else model.fixed.copy()
    if control.suppressed is not None:
        suppressed = np.tile(np.array(control.suppressed, bool), (len(fixed), 1))
        for block in model.blocks:
            if (
                block.family == "shell"
            ):  # PAK's sixth is the turn about the normal, which our shells tie to the membrane
                suppressed[block.nodes.ravel(), 5] = False
        fixed |= suppressed
    for constraint in model.constraints:
        fixed[constraint.nodes] |= constraint.dofs
    return fixed


def _index(curve: int | None, numbers: list[int]) -> int | None:
    return None if curve is None else numbers.index(curve)


def _initial(load: NodalLoad) -> bool:
    return bool(load.native.get("initial"))


def _force(load: NodalLoad, numbers: list[int]) -> fem.NodalLoad:
    shift = float(load.native.get("FPOM", 0.0))
    return fem.NodalLoad(load.nodes, load.dofs - 1, load.values, _index(load.curve, numbers), shift)


def _motion(load: NodalLoad, numbers: list[int]) -> fem.Motion:
    return fem.Motion(load.nodes, load.dofs - 1, load.values, _index(load.curve, numbers),
                      bool(load.native.get("incremental")))  # fmt: skip


def _face_loads(model: Model, load: FaceLoad, numbers: list[int], *, follows: bool) -> list[fem.FaceLoad]:
    """A load for each shape of its faces, with the values of corners brought to mid-side nodes."""
    flat = model.dimension == 2
    count = (load.faces >= 0).sum(axis=1)
    if load.faces.shape[1] > 3:  # triangles with mid-side nodes lie behind an absent fourth corner
        count = np.where(load.faces[:, 3] < 0, np.where(count > 3, 6, 3), count)
    found = []
    for size in np.unique(count).tolist():
        rows = count == size
        kind = {2: "line2", 3: "line3"}[size] if flat else _FACES[size]
        order = [0, 1, 2, 4, 5, 6] if kind == "tri6" else list(range(size))
        nodes = load.faces[rows][:, order]
        given = load.values[rows]
        values = np.repeat(given, size, axis=1) if given.shape[1] == 1 else _to_nodes(given, kind)
        thickness = np.full(len(nodes), load.native.get("THICV") or 1.0) if flat else None
        plane = next((s.plane for s in model.sections.values() if s.plane), "") if flat else ""
        if flat:
            nodes, values = _outward(model, nodes, values)
        found.append(fem.FaceLoad(kind, nodes, values, load.direction, _index(load.curve, numbers),
                                  follows and load.direction == 0, thickness, plane))  # fmt: skip
    return found


def _to_nodes(corners: Any, kind: str) -> Any:
    """Values (f, c) at corners of faces as values (f, n) at all nodes: linear along the edges."""
    element = TABLE[kind]
    own = corners[:, : element.shape.corners]
    pieces = [own] + [0.5 * (own[:, a] + own[:, b])[:, None] for a, b in element.shape.edges if element.mid_edges]
    if kind == "quad9":
        pieces.append(own.mean(axis=1)[:, None])
    return np.column_stack(pieces)


def _outward(model: Model, edges: Any, values: Any) -> tuple[Any, Any]:
    """Edges of plane elements turned so that pressure, which acts to the left of their way, goes into the element."""
    n = len(model.xyz)
    keys, centres = [], []
    for block in model.blocks:
        middle = model.xyz[block.nodes].mean(axis=1)
        for a, b in TABLE[block.kind].shape.edges:
            pair = np.sort(block.nodes[:, [a, b]], axis=1)
            keys.append(pair[:, 0] * n + pair[:, 1])
            centres.append(middle)
    key, centre = np.concatenate(keys), np.concatenate(centres)
    order = np.argsort(key)
    pair = np.sort(edges[:, :2], axis=1)
    wanted = pair[:, 0] * n + pair[:, 1]
    place = order[np.minimum(np.searchsorted(key[order], wanted), len(order) - 1)]
    start = model.xyz[edges[:, 0]]
    way, inward = model.xyz[edges[:, 1]] - start, centre[place] - start
    turned = (key[place] == wanted) & (way[:, 0] * inward[:, 1] < way[:, 1] * inward[:, 0])
    edges, values = edges.copy(), values.copy()
    edges[turned, :2], values[turned, :2] = edges[turned, 1::-1], values[turned, 1::-1]
    return edges, values


def _materials(model: Model, parts: tuple[int, ...] | None) -> tuple[int, ...] | None:
    return None if parts is None else tuple(model.parts[p].material or 0 for p in parts)


def _iteration(control: FemControl, method: Fem) -> fem.Iteration:
    """PAK's METOD and tolerances. Forces are to be in balance to 1e-6 whatever the deck's own tolerances allow."""
    metod = control.iteration
    energy, force = (t if on else 0.0 for t, on in zip(control.tolerances[:2], control.converge_on[:2], strict=True))
    return fem.Iteration(
        method=method.iteration,
        search=metod in (4, 63) if method.search is None else method.search,
        most=method.most or max(control.max_iterations, 15),
        energy=energy,
        force=method.tolerance or (min(force, FORCE) if force else FORCE),
        cuts=method.cuts,
    )


def _path(model: Model, control: FemControl, method: Fem) -> fem.Path | None:
    """PAK's automatic loading (METOD 61, 63: arc length; 71, 73: displacement control), or the scene's."""
    said = method.path
    if said is not None:
        return fem.Path(_node(model, said.node), _AXES.index(said.direction), said.first, said.controlled)
    if control.iteration < 60 or len(control.loading) < 4:
        return None
    _, node, dof, first = control.loading[:4]
    return fem.Path(_node(model, int(node)), int(dof) - 1, float(first), control.iteration in (71, 73))


def _node(model: Model, number: int) -> int:
    found = np.flatnonzero(model.node_ids == number)
    if not len(found):
        raise ValueError(f"the path of loading is measured at node {number}, which there is not")
    return int(found[0])


_AXES = ("ux", "uy", "uz", "rx", "ry", "rz")
FORCE = 1e-6  # unbalanced force over the largest one


def _dynamics(control: FemControl, said: Fem) -> fem.Dynamics | None:
    if not control.dynamic or control.eigenvalues:
        return None
    first, second = control.integration_parameters
    method = {1: "wilson", 2: "newmark", -2: "newmark", 3: "central"}.get(control.integration, "newmark")
    method = method if said.integration == "deck" else said.integration
    rayleigh = control.rayleigh if control.damping == 3 else (0.0, 0.0)
    return fem.Dynamics(
        method=method,
        gamma=first or 0.5 if method == "newmark" else 0.5,
        beta=second or 0.25 if method == "newmark" else 0.25,
        alpha=said.alpha,
        theta=first or 1.4 if method == "wilson" else 1.4,
        lumped=control.mass == 2 or method == "central",
        mass_damping=rayleigh[0],
        stiffness_damping=rayleigh[1],
    )


def _initial_values(model: Model, kind: str, n: int) -> Any:
    values = np.zeros((n, 6))
    for load in model.nodal_loads:
        if load.kind == kind and _initial(load):
            values[load.nodes, load.dofs - 1] = load.values
    return values if values.any() else None


def _velocities(model: Model, n: int) -> Any:
    values = np.zeros((n, 6))
    for start in model.initial_velocities:
        values[start.nodes, :3] = start.velocity
        if start.rotation is not None:
            values[start.nodes, 3:] = start.rotation
    return values if values.any() else None

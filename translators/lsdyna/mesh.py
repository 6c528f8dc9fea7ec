"""*NODE and *ELEMENT_...: the tables of the mesh, read as arrays. What the rows mean together, `assemble` finds out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zrno.translators.lsdyna.cards import Table
from zrno.translators.lsdyna.deck import Deck, ElementRun, NodeRun
from zrno.translators.lsdyna.keywords import Registry, take
from zrno.translators.lsdyna.lexer import Block, Widths
from zrno.translators.model import Ints

MESH = Registry()

_BLANK, _COMMA = b" ,"
_ROWS_AT_A_TIME = 200_000
_NODES = {"H20": 20, "H27": 27, "T15": 15, "P21": 21, "H64": 64}
# LS-DYNA makes other elements of these itself: they are read as they stand.
_CONVERTED = (
    "TET4TOTET10", "T4TOT10", "T4TOT15", "H8TOH20", "H8TOH27", "H8TOH64", "P6TOP21",
)  # fmt: skip
_PINS = "rt1/i8 rr1/i8 rt2/i8 rr2/i8 local/i8"


@MESH("NODE")
def _node(deck: Deck, block: Block, options: list[str]) -> bool:
    if options:
        return False
    rows = block.rows()
    spec = "nid/i8 xyz/16*3 tc/i8 rc/i8"
    if _two_lines(block, rows):  # as older manuals have the long format
        rows = block.rows(blank=False)
        table = Table(deck, block, rows[::2], "nid/i8 xyz/16*3")
        codes = Table(deck, block, rows[1::2], "tc/i8 rc/i8")
        tc, rc = codes["tc"], codes["rc"]
    else:
        table = Table(deck, block, rows, spec).without_blank("nid")
        tc, rc = table["tc"], table["rc"]
    rows = table.rows
    for name, code in (("tc", tc), ("rc", rc)):
        for i in np.flatnonzero((code < 0) | (code > 7))[:20].tolist():
            deck.fault(block.file, int(rows[i]), 0, f"{name} is no constraint code", str(code[i]), "0 to 7")
    for i in np.flatnonzero(table["nid"] <= 0)[:20].tolist():
        table.fault(i, "nid", "a node's number is not positive", "1 or more")
    xyz = table["xyz"]
    if deck.frame.length != 1.0:
        xyz = xyz * deck.frame.length
    run = NodeRun(block, table.rows, table.ids("nid", "node"), xyz, tc, rc, deck.frame.transformations)
    deck.nodes.append(run)
    return True


def _two_lines(block: Block, rows: Ints) -> bool:
    """Whether a node in long format takes two lines: number and place, then the codes alone."""
    if block.widths is not Widths.LONG or len(rows) < 2 or len(rows) % 2:
        return False
    lengths = [len(block.file.text(int(row)).rstrip()) for row in rows[:20]]
    return all(40 < n <= 80 for n in lengths[::2]) and all(n <= 40 for n in lengths[1::2])


@MESH("ELEMENT_SOLID")
def _solid(deck: Deck, block: Block, options: list[str]) -> bool:
    for word in _CONVERTED:
        if word in options:
            options.remove(word)
            deck.count(f"{{n}} *ELEMENT_SOLID_{word} keywords: the elements are read without their new nodes", 1, block)
    large = next((word for word in _NODES if take(options, word)), None)
    ortho, dof = take(options, "ORTHO"), take(options, "DOF")
    take(options, "FORMAT2")
    if options or (large and ortho):
        return False
    if dof:
        deck.count("{n} *ELEMENT_SOLID_DOF keywords: the further degrees of freedom are not read", 1, block)
    if large:
        _large(deck, block, block.rows(blank=dof), large, dof)
        return True
    if not (ortho or dof):
        return _plain(deck, block)
    rows = block.rows()
    if not len(rows):
        return True
    short = _short(block, rows)
    per = 1 + int(short[0]) + 2 * ortho + dof
    rows = _whole(deck, block, rows, per)
    head = rows[::per]
    run = _two_line(deck, block, head, rows[1::per]) if short[0] else _one_line(deck, block, head)
    if ortho:
        first = per - 2 - dof
        run.data["axis_a"] = Table(deck, block, rows[first::per], "a/16*3")["a"]
        run.data["axis_d"] = Table(deck, block, rows[first + 1 :: per], "d/16*3")["d"]
    deck.elements.append(run)
    return True


def _plain(deck: Deck, block: Block) -> bool:
    """Elements of one line, of two, or both. A second field without a third begins an element of two lines."""
    table = Table(deck, block, block.rows(), "eid/i8 pid/i8 nodes/i8*8").without_blank("eid")
    if not len(table):
        return True
    rows, nodes = table.rows, table["nodes"]
    short = np.zeros(len(rows), bool)
    maybe = np.flatnonzero(nodes[:, 0] == 0)
    if len(maybe):
        short[maybe] = _short(block, rows[maybe])
    heads = np.flatnonzero(short)
    if not len(heads):
        deck.elements.append(_run(deck, "solid", table, "solid"))
        return True
    follows = np.zeros(len(rows) + 1, bool)
    follows[heads + 1] = True
    wrong = np.flatnonzero(follows[:-1] & short)
    # a row of two numbers behind another, or at the end: it lacks its nodes
    bare = [*rows[wrong - 1].tolist()[:20], *([int(rows[-1])] if follows[-1] else [])]
    for row in bare:
        deck.fault(block.file, row, 0, "an element without nodes", block.file.text(row).strip(), "a line of nodes")
    if len(wrong) or follows[-1]:
        return True
    if len(heads):
        deck.elements.append(_two_line(deck, block, rows[heads], rows[heads + 1]))
    one = rows[~(short | follows[:-1])] if len(heads) else rows
    if len(one):
        deck.elements.append(_one_line(deck, block, one))
    return True


def _one_line(deck: Deck, block: Block, rows: Ints) -> ElementRun:
    return _run(deck, "solid", Table(deck, block, rows, "eid/i8 pid/i8 nodes/i8*8"), "solid")


def _two_line(deck: Deck, block: Block, heads: Ints, rows: Ints) -> ElementRun:
    run = _run(deck, "solid", Table(deck, block, heads, "eid/i8 pid/i8"), "solid", nodes=False)
    run.nodes = Table(deck, block, rows, "nodes/i8*10").ids("nodes", "node")
    return run


def _large(deck: Deck, block: Block, rows: Ints, word: str, dof: bool) -> None:
    count = _NODES[word]
    cards = -(-count // 10)
    per = 1 + cards + dof
    rows = _whole(deck, block, rows, per)
    if not len(rows):
        return
    run = _run(deck, "solid", Table(deck, block, rows[::per], "eid/i8 pid/i8"), word, nodes=False)
    parts = [Table(deck, block, rows[1 + i :: per], "nodes/i8*10").ids("nodes", "node") for i in range(cards)]
    run.nodes = np.ascontiguousarray(np.concatenate(parts, axis=1)[:, :count])
    deck.elements.append(run)


@MESH("ELEMENT_SHELL")
def _shell(deck: Deck, block: Block, options: list[str]) -> bool:
    beta, mcid = take(options, "BETA"), take(options, "MCID")
    thick = take(options, "THICKNESS") or beta or mcid
    offset, dof = take(options, "OFFSET"), take(options, "DOF")
    if options:
        return False
    if dof:
        deck.count("{n} *ELEMENT_SHELL_DOF keywords: the further degrees of freedom are not read", 1, block)
    rows = block.rows()
    if not len(rows):
        return True
    spec = "eid/i8 pid/i8 nodes/i8*8"
    if not (thick or offset or dof):
        deck.elements.append(_run(deck, "shell", Table(deck, block, rows, spec).without_blank("eid"), "shell"))
        return True
    # elements with mid-nodes have a second card of thicknesses
    head, middle, bad = [], [], False
    row, after = 0, offset + dof + thick
    if thick:
        first = Table(deck, block, rows[:1], spec)
        per = 1 + after + bool(first["nodes"][0, 4:].any())
        rows = block.blank_behind(rows, -len(rows) % per)
        heads = rows[: len(rows) - len(rows) % per : per]
        table = Table(deck, block, heads, spec)
        uniform = len(rows) % per == 0 and bool(
            (table["nodes"][:, 4:].any(axis=1) == bool(first["nodes"][0, 4:].any())).all()
        )
        if not uniform:
            while row < len(rows):
                nodes = Table(deck, block, rows[row : row + 1], spec)["nodes"][0, 4:]
                head.append(row)
                middle.append(bool(nodes.any()))
                row += 1 + after + middle[-1]
            bad = row != len(rows)
            places = np.array(head)
        else:
            places = np.arange(0, len(rows), per)
    else:
        per = 1 + after
        rows = _whole(deck, block, rows, per)
        places = np.arange(0, len(rows), per)
    if bad or not len(places):
        if bad:
            deck.fault(block.file, int(rows[-1]), 0, "the keyword ends inside an element", "", "its further cards")
        return True
    run = _run(deck, "shell", Table(deck, block, rows[places], spec), "shell")
    follows = places + 1
    if thick:
        card = Table(deck, block, rows[follows], "thickness/16*4 angle/16")
        if card["thickness"].any():
            run.data["thickness"] = card["thickness"] * deck.frame.length
        if mcid:
            deck.count("{n} *ELEMENT_SHELL_MCID keywords: the elements' material systems are not read", 1, block)
        elif card["angle"].any():
            run.data["angle"] = card["angle"]
        follows = follows + 1 + (run.nodes[:, 4:] != 0).any(axis=1)
    if offset:
        run.data["offset"] = Table(deck, block, rows[follows], "offset/16")["offset"] * deck.frame.length
    deck.elements.append(run)
    return True


@MESH("ELEMENT_TSHELL")
def _tshell(deck: Deck, block: Block, options: list[str]) -> bool:
    beta = take(options, "BETA")
    if options:
        return False
    rows = block.rows(blank=beta)
    per = 1 + beta
    rows = _whole(deck, block, rows, per)
    if len(rows):
        run = _run(deck, "tshell", Table(deck, block, rows[::per], "eid/i8 pid/i8 nodes/i8*8"), "solid")
        if beta:
            run.data["angle"] = Table(deck, block, rows[1::per], "unused/16*4 angle/16")["angle"]
        deck.elements.append(run)
    return True


@MESH("ELEMENT_BEAM")
def _beam(deck: Deck, block: Block, options: list[str]) -> bool:
    # cards follow in this order, whatever the name's
    words = ("THICKNESS", "SCALAR", "SECTION", "PID", "OFFSET", "ORIENTATION")
    given = [word for word in words if take(options, word)]
    if options:
        return False
    rows = block.rows(blank=bool(given))
    per = 1 + len(given)
    rows = _whole(deck, block, rows, per)
    if not len(rows):
        return True
    table = Table(deck, block, rows[::per], f"eid/i8 pid/i8 nodes/i8*2 third/i8 {_PINS}")
    run = _run(deck, "beam", table, "beam")
    run.data["orientation_node"] = table.ids("third", "node")
    pins = np.stack([table[name] for name in ("rt1", "rr1", "rt2", "rr2", "local")], axis=1)
    if (pins[:, :4] != 0).any() or ((pins[:, 4] != 0) & (pins[:, 4] != 2)).any():
        run.data["releases"] = pins
    length = deck.frame.length
    for i, word in enumerate(given, 1):
        cards = rows[i::per]
        if word == "THICKNESS":
            run.data["section_values"] = Table(deck, block, cards, "v/16*5")["v"]
            if length != 1.0:
                deck.warn(block, "*INCLUDE_TRANSFORM: the sections of these beams are not scaled")
        elif word == "ORIENTATION":
            run.data["orientation"] = Table(deck, block, cards, "v*3")["v"]
        elif word == "OFFSET":
            run.data["offsets"] = Table(deck, block, cards, "v*6")["v"] * length
        elif word == "SCALAR":
            card = Table(deck, block, cards, "volume/16 inertia/16")
            run.data["volume"] = card["volume"] * deck.frame.scale(length=3)
            run.data["inertia"] = card["inertia"] * deck.frame.scale(mass=1, length=2)
        else:
            deck.count(f"{{n}} beams' cards of the option {word} are not read", len(cards), block)
    deck.elements.append(run)
    return True


@MESH("ELEMENT_DISCRETE")
def _discrete(deck: Deck, block: Block, options: list[str]) -> bool:
    if options:
        return False
    table = Table(deck, block, block.rows(blank=False), "eid/i8 pid/i8 nodes/i8*2 vid/i8 scale/16 print/i8 offset/16")
    run = _run(deck, "spring", table, "spring")
    if table["vid"].any():
        run.data["direction"] = table.ids("vid", "define")
    scale = np.where(table["scale"] == 0, 1.0, table["scale"])
    if (scale != 1).any():
        run.data["scale"] = scale
    if table["print"].any():
        run.data["print"] = table["print"]
    if table["offset"].any():
        run.data["offset"] = table["offset"] * deck.frame.length
    deck.elements.append(run)
    return True


@MESH("ELEMENT_MASS")
def _mass(deck: Deck, block: Block, options: list[str]) -> bool:
    if options:
        return False
    table = Table(deck, block, block.rows(blank=False), "eid/i8 nodes/i8 mass/16 pid/i8")
    run = _run(deck, "mass", table, "point")
    run.data["mass"] = table["mass"] * deck.frame.mass
    deck.elements.append(run)
    return True


@MESH("ELEMENT_SPH")
def _sph(deck: Deck, block: Block, options: list[str]) -> bool:
    volume = take(options, "VOLUME")
    if options:
        return False
    table = Table(deck, block, block.rows(blank=False), "nodes/i8 pid/i8 mass/16 nend/i8")
    run = _run(deck, "sph", table, "point")
    mass = table["mass"]
    negative = (mass < 0) | volume
    mass = abs(mass)
    if (~negative).any():
        run.data["mass"] = np.where(negative, 0.0, mass * deck.frame.mass)
    if negative.any():
        run.data["volume"] = np.where(negative, mass * deck.frame.scale(length=3), 0.0)
    if table["nend"].any():
        run.data["last"] = table.ids("nend", "node")
    deck.elements.append(run)
    return True


@MESH("ELEMENT_DISCRETE_SPHERE")
def _sphere(deck: Deck, block: Block, options: list[str]) -> bool:
    volume = take(options, "VOLUME")
    if options:
        return False
    rows = block.rows(blank=False)
    # sources give two layouts, of ids in eight columns and all in ten: the rows show which it is
    wide = "nodes/i8 pid/i8 mass/16 inertia/16 radius/16 nend/i8"
    narrow = "nodes/i pid/i mass inertia radius unused*2 nend/i"
    table = Table(deck, block, rows, narrow if _ids_in_tens(block, rows) else wide)
    run = _run(deck, "sphere", table, "point")
    frame = deck.frame
    run.data["volume" if volume else "mass"] = table["mass"] * (frame.scale(length=3) if volume else frame.mass)
    run.data["inertia"] = table["inertia"] * frame.scale(length=5 if volume else 2, mass=0 if volume else 1)
    run.data["radius"] = table["radius"] * frame.length
    if table["nend"].any():
        run.data["last"] = table.ids("nend", "node")
    deck.elements.append(run)
    return True


def _ids_in_tens(block: Block, rows: Ints) -> bool:
    """Whether the first number of the first rows ends at column 10, as it does right-justified in ten columns."""
    if block.widths is not Widths.STANDARD:
        return False
    texts = [text for row in rows[:50].tolist() if "," not in (text := block.file.text(row))]
    return bool(texts) and all(len(t) - len(t.lstrip()) + len(t.split()[0]) == 10 for t in texts)


def _run(deck: Deck, family: str, table: Table, shape: str, *, nodes: bool = True) -> ElementRun:
    """A run of elements; points have their nodes' numbers."""
    points = nodes and table["nodes"].ndim == 1
    found = table.ids("nodes", "node") if nodes else np.empty((0, 8), np.int64)
    if points:
        found = found[:, None]
    own = "eid" in table.values
    ids = table.ids("eid", "element") if own else found[:, 0].copy()
    for i in np.flatnonzero(ids <= 0)[:20].tolist():
        table.fault(i, "eid" if own else "nodes", "an element's number is not positive", "1 or more")
    part = table.ids("pid", "part")
    return ElementRun(family, table.block, table.rows, ids, part, found, shape)


def _whole(deck: Deck, block: Block, rows: Ints, per: int) -> Ints:
    """The rows of whole elements, each of `per` cards; a fault where the last is cut."""
    rest = len(rows) % per
    if rest:
        rows = block.blank_behind(rows, per - rest)
        rest = len(rows) % per
    if rest:
        deck.fault(block.file, int(rows[-1]), 0, "the keyword ends inside an element", "", f"{per} lines for each")
        return rows[: len(rows) - rest]
    return rows


def _short(block: Block, rows: Ints) -> NDArray[np.bool_]:
    """Rows with no more than an element's number and its part: the third field is blank, or there is one comma."""
    file, width = block.file, block.widths.of(8)
    short = np.empty(len(rows), bool)
    columns = 2 * width + np.arange(width)
    commas = bool((file.bytes[int(file.starts[rows[0]]) : int(file.ends[rows[-1]])] == _COMMA).any())
    for start in range(0, len(rows), _ROWS_AT_A_TIME):
        part = rows[start : start + _ROWS_AT_A_TIME]
        ends = file.ends[part] - file.starts[part]
        blank = ends <= 2 * width
        long = np.flatnonzero(~blank)
        places = file.starts[part[long]][:, None] + columns
        grid = file.bytes[np.minimum(places, len(file.bytes) - 1)]
        inside = columns < ends[long][:, None]
        blank[long] = ~((grid > _BLANK) & inside).any(axis=1)
        if commas:
            low = int(file.starts[part[0]])
            region = file.bytes[low : int(file.ends[part[-1]])]
            places = low + np.flatnonzero(region == _COMMA)
            row = np.searchsorted(file.starts[part], places, side="right") - 1
            count = np.bincount(row[places < file.ends[part][row]], minlength=len(part))
            blank = np.where(count > 0, count < 2, blank)
        short[start : start + len(part)] = blank
    return short

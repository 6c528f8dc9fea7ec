"""A fuzzer of the readers: mutated files, read in a process with limits on time and memory.

    .venv/bin/python tests/translators/fuzzing.py [COUNT] [FIRST] [FORMAT ...]        FORMAT: msh k neu dat mcm

Every file must give a model or an InputError with places, within 5 seconds and within 64 MB and ten times the file
above the memory that the process had before. The seeds are small decks and meshes of every format that the project's
own writers make, and the real ones beside the repository where they are there.
"""

from __future__ import annotations

import contextlib
import faulthandler
import multiprocessing
import random
import re
import resource
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

SUFFIXES = (".msh", ".k", ".key", ".dyn", ".neu", ".dat", ".mcm")
LIMIT_SECONDS = 5.0
LIMIT_BYTES = 64 << 20
LARGEST_SEED = 60_000  # bytes: mutants are many, so they are small

_WILD = (
    b"0", b"-1", b"1", b"99999999", b"2147483648", b"1000000000000000000", b"9" * 25, b"1e308", b"1e999", b"-0.0",
    b"nan", b"inf", b"1.5.2", b"x", b"", b" ", b"1-", b"+", b".", b"&a", b"1,2", b"0x10", b"1e", b"1844674407370955",
)  # fmt: skip
_INSERTS = (
    b"\0", b"\r", b"\n\n", b"\xff\xfe", b"*INCLUDE\nself.k\n", b"*INCLUDE\n../../../etc/passwd\n",
    b"*PARAMETER\nRa      &a\n", b"*PARAMETER_EXPRESSION\nRb      b+1\n", b"$EndNodes\n", b"   -1\n", b"*END\n",
    b" " * 500, b"9" * 500, b"(" * 300, b"-1,-1,-1,\n",
)  # fmt: skip

Mutation = Callable[[random.Random, bytes], bytes]


def _cut(rng: random.Random, data: bytes) -> bytes:
    return data[: rng.randrange(len(data) + 1)]


def _lines(change: Callable[[random.Random, list[bytes]], None]) -> Mutation:
    def mutate(rng: random.Random, data: bytes) -> bytes:
        lines = data.split(b"\n")
        change(rng, lines)
        return b"\n".join(lines)

    return mutate


def _duplicate(rng: random.Random, lines: list[bytes]) -> None:
    a = rng.randrange(len(lines))
    b = min(len(lines), a + rng.randint(1, 8))
    lines[b:b] = lines[a:b] * rng.choice((1, 1, 2, 50))


def _delete(rng: random.Random, lines: list[bytes]) -> None:
    a = rng.randrange(len(lines))
    del lines[a : a + rng.randint(1, 5)]


def _swap(rng: random.Random, lines: list[bytes]) -> None:
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]


def _shuffle(rng: random.Random, lines: list[bytes]) -> None:
    a = rng.randrange(len(lines))
    part = lines[a : a + 20]
    rng.shuffle(part)
    lines[a : a + 20] = part


def _number(rng: random.Random, data: bytes) -> bytes:
    """One number becomes another, wild one."""
    found = list(re.finditer(rb"[-+]?\d+(\.\d*)?([eE][-+]?\d+)?", data))
    if not found:
        return data
    match = rng.choice(found)
    wild = rng.choice(_WILD)
    if rng.random() < 0.5:
        wild = wild.rjust(match.end() - match.start())[: match.end() - match.start()]
    return data[: match.start()] + wild + data[match.end() :]


def _byte(rng: random.Random, data: bytes) -> bytes:
    changed = bytearray(data or b" ")
    for _ in range(rng.choice((1, 1, 3, 20))):
        changed[rng.randrange(len(changed))] = rng.choice(
            (0, 9, 10, 13, 32, 36, 42, 44, 45, 46, 48, 57, 101, 128, 228, 255)
        )
    return bytes(changed)


def _insert(rng: random.Random, data: bytes) -> bytes:
    at = rng.randrange(len(data) + 1)
    extra = rng.choice(_INSERTS)
    return data[:at] + extra + data[at:]


def _crlf(rng: random.Random, data: bytes) -> bytes:
    return data.replace(b"\n", b"\r\n")


MUTATIONS: tuple[Mutation, ...] = (
    _cut, _lines(_duplicate), _lines(_delete), _lines(_swap), _lines(_shuffle), _number, _number, _number, _byte, _byte,
    _insert, _crlf,
)  # fmt: skip


def mutant(rng: random.Random, seed: bytes) -> bytes:
    """A file made of a seed by one or a few changes."""
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        seed = rng.choice(MUTATIONS)(rng, seed)
    return seed


@dataclass(frozen=True, slots=True)
class Seed:
    """name: with the extension that the reader is chosen by."""

    name: str
    data: bytes


def seeds_of(folders: list[Path]) -> Iterator[Seed]:
    """The small files of folders that some reader of ours reads."""
    for folder in folders:
        for path in sorted(folder.rglob("*")):
            if (
                path.suffix in (".msh", ".k", ".key", ".dyn", ".neu", ".dat", ".mcm")
                and path.stat().st_size <= LARGEST_SEED
            ):
                yield Seed(path.name, path.read_bytes())


def written_seeds() -> Iterator[Seed]:
    """A small mesh and a small particle deck in every format that we write."""
    from zrno.translators import write
    from zrno.translators.formats import FORMATS
    from zrno.translators.model import ElementBlock, Material, Model, NodeSet, Part, ParticleControl, Particles

    grid = np.stack(np.meshgrid(range(3), range(3), range(3), indexing="ij"), axis=-1).reshape(-1, 3).astype(float)
    corner = np.array([0, 9, 12, 3, 1, 10, 13, 4])
    cubes = ElementBlock("hex8", np.arange(1, 5), np.array([corner + k for k in (0, 1, 3, 9)]), np.array([1, 1, 2, 2]))
    mesh = Model("seed", node_ids=np.arange(1, 28), xyz=grid, blocks=[cubes], parts={1: Part(1, "a"), 2: Part(2, "b")})
    mesh.node_sets = [NodeSet(1, "floor", np.arange(9))]
    deck = Model("seed", particles=Particles(grid, np.ones(27, int), np.zeros(27, int), np.ones((27, 3))))
    deck.materials[1] = Material(1, "sand", "elastic", 2.0, {"E": 1.0, "nu": 0.3}, 1.0, 0.1)
    deck.particle_control = ParticleControl(end_time=1.0, planes=[(1, 0.0)] * 6, base_acceleration=(0.0, 0.0, -1.0))
    with tempfile.TemporaryDirectory() as folder:
        for row in FORMATS:
            for suffix in row.extensions if row.writer else ():
                path = Path(folder) / f"written{suffix}"
                for model in (mesh, deck):
                    with contextlib.suppress(ValueError):  # a format for the other of the two
                        write(model, path)
                        yield Seed(path.name, path.read_bytes())
                        break


def all_seeds() -> list[Seed]:
    """What we write ourselves, and the real files beside the repository where they are there."""
    shared = Path(__file__).resolve().parents[3] / "shared"
    return [*written_seeds(), *seeds_of([f for f in (shared / "samples", shared / "reference") if f.is_dir()])]


def judge(path: Path) -> str:
    """Read a file; "" where the reader kept its promise, else what it did."""
    from zrno.translators import InputError, read

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            read(path)
    except InputError as error:
        if not error.faults or any(fault.line < 1 or fault.column < 1 or not fault.message for fault in error.faults):
            return f"a fault without a place: {error}"
    except MemoryError:
        return "out of memory"
    except BaseException as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__}: {str(error)[:120]} ({Path(last.filename).name}:{last.lineno})"
    return ""


def _work(seeds: list[Seed], count: int, start: int, folder: str, results: object) -> None:
    """One worker: its own memory limit; tells each file's number before it reads it."""
    import zrno.translators.scan
    from zrno.translators import read

    assert zrno.translators.scan, read
    faulthandler.enable()
    where = Path(folder)
    for number in range(start, start + count):
        rng = random.Random(number)
        seed = rng.choice(seeds)
        data = mutant(rng, seed.data)
        path = where / seed.name
        path.write_bytes(data)
        used = _address_space()
        resource.setrlimit(resource.RLIMIT_DATA, (used + LIMIT_BYTES + 10 * len(data), resource.RLIM_INFINITY))
        results.put((number, seed.name, None))  # type: ignore[attr-defined]
        began = time.perf_counter()
        wrong = judge(path)
        seconds = time.perf_counter() - began
        resource.setrlimit(resource.RLIMIT_DATA, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        if not wrong and seconds > LIMIT_SECONDS:
            wrong = f"{seconds:.1f} s"
        results.put((number, seed.name, wrong))  # type: ignore[attr-defined]


def _address_space() -> int:
    """Bytes of private data that this process has."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmData:"):
            return int(line.split()[1]) << 10
    return 0


def fuzz(seeds: list[Seed], count: int, start: int = 0) -> dict[int, str]:
    """Read `count` mutants, numbered from `start`; what went wrong, by number (which makes the file again)."""
    context = multiprocessing.get_context("fork")
    wrong: dict[int, str] = {}
    done = 0
    with tempfile.TemporaryDirectory() as folder:
        while done < count:
            results = context.Queue()
            worker = context.Process(target=_work, args=(seeds, count - done, start + done, folder, results))
            worker.start()
            current, name, since = start + done, "", time.perf_counter()
            while done < count:
                try:
                    number, name, said = results.get(timeout=1.0)
                except Exception:  # queue.Empty
                    late = time.perf_counter() - since > 4 * LIMIT_SECONDS
                    if worker.is_alive() and not late:
                        continue
                    wrong[current] = f"{name}: {'hangs' if late else f'the process died ({worker.exitcode})'}"
                    worker.kill()
                    done = current - start + 1
                    break
                since = time.perf_counter()
                if said is None:
                    current = number
                    continue
                done = number - start + 1
                if said:
                    wrong[number] = f"{name}: {said}"
            worker.join(timeout=5)
    return wrong


def main(words: list[str]) -> int:
    """Fuzz from the command line."""
    count = int(words[0]) if words else 20_000
    start = int(words[1]) if len(words) > 1 else 0
    kinds = words[2:]
    seeds = [seed for seed in all_seeds() if not kinds or Path(seed.name).suffix[1:] in kinds]
    print(f"{len(seeds)} seeds, {count} files from {start} on: {dict(Counter(Path(s.name).suffix for s in seeds))}")
    began = time.perf_counter()
    wrong = fuzz(seeds, count, start)
    for number, said in wrong.items():
        print(f"  {number}: {said}")
    print(f"{len(wrong)} of {count} went wrong, {time.perf_counter() - began:.0f} s")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""Decks that the tests of the LS-DYNA translator share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from zrno.translators.lsdyna import read
from zrno.translators.model import Model

CUBE = """\
*NODE
       1             0.0             0.0             0.0
       2             1.0             0.0             0.0
       3             1.0             1.0             0.0
       4             0.0             1.0             0.0
       5             0.0             0.0             1.0
       6             1.0             0.0             1.0
       7             1.0             1.0             1.0
       8             0.0             1.0             1.0
"""

EVERYTHING = f"""\
$ A deck of all that is read, small enough to be looked through.
*KEYWORD
*TITLE
All of it
*CONTROL_TERMINATION
      12.5         0       0.0
*CONTROL_TIMESTEP
    1.E-05       0.9
*DATABASE_BINARY_D3PLOT
      0.25
*CONTROL_SPH
         1         0   1.0E20         3
*PARAMETER
R      rho   7.85E-9R        E  210000.0I    fifty        50
*PARAMETER_EXPRESSION
R    shear  &E/(2*(1+0.3))
*DEFINE_CURVE_TITLE
up and down
         7         0       2.0       3.0       1.0
                 0.0                 0.5
                10.0                 1.5
*DEFINE_CURVE
8
0,1
1,2.5
*DEFINE_COORDINATE_SYSTEM_TITLE
turned
         3       0.0       0.0       1.0       0.0       1.0       1.0
      -1.0       0.0       1.0
*DEFINE_BOX
         1      -1.0       0.5      -1.0       2.0      -1.0       2.0
*DEFINE_VECTOR
         2       0.0       0.0       0.0       0.0       0.0      -1.0
*PART
a block, of steel
         1         1         1         0         5
*PART
shell
         2         2         2
beam
         3         3         3
*PART_CONTACT
sand
         4         4         4
       0.3       0.2
*PART
balls
         5         4         5         1
*PART
spring
         6         6         6
*SECTION_SOLID
         1         1
*SECTION_SHELL_TITLE
two millimetres
         2        16       0.8         5
       2.0       2.0       2.0       2.0
*SECTION_BEAM
         3         2
       1.5      0.25       0.5      0.75
*SECTION_SPH
         4       1.1       0.3       2.5       9.0
*SECTION_DISCRETE
         6         0
*MAT_ELASTIC_TITLE
steel
         1      &rho        &E       0.3
*MAT_003
         2   7.85E-9  210000.0       0.3     250.0    1000.0       0.5
      40.0       5.0       0.2       0.0
*MAT_PIECEWISE_LINEAR_PLASTICITY
         3   7.85E-9  210000.0       0.3     250.0       0.0       0.4       0.0
      40.0       5.0         7         0       0.0
       0.0       0.1       0.5       0.0       0.0       0.0       0.0       0.0
     250.0     300.0     350.0       0.0       0.0       0.0       0.0       0.0
*MAT_GEOLOGIC_CAP_MODEL
         4   1.85E-9      30.6      8.23   0.03858      0.03   0.03858       9.0
       2.0      7.25      0.18       0.1
       1.0       2.0       0.0     -0.02
*MAT_NULL
         5   1.85E-9      -0.1      1E-6
*MAT_SPRING_ELASTIC
         6     100.0
*EOS_GRUNEISEN
         1    1647.0      1.92       0.0       0.0       0.1       0.0       0.0
       1.0
*HOURGLASS
         5         4
*SET_NODE_LIST_TITLE
the bottom
        10
         1         2         3         4
*SET_NODE_GENERAL
        11
       BOX         1
     DNODE         8
*SET_PART_LIST
        12
         1         2
*SET_SEGMENT
        13
         5         6         7         8
         5         6         7         7
*SET_SOLID_GENERATE
        14
         1    &fifty
*BOUNDARY_SPC_SET_ID
       101held below
        10         0         1         1         1         0         0         0
*BOUNDARY_SPC_NODE
         5         3         1         0         0         0         0         0
         6         3         0         1         0         0         0         0
*BOUNDARY_SPC_NODE_BIRTH_DEATH
         7         0         0         0         1         0         0         0
       0.5      20.0
*BOUNDARY_PRESCRIBED_MOTION_SET
        10         3         2         7       2.0
*BOUNDARY_PRESCRIBED_MOTION_NODE
         8         4         0         8       1.5         2      10.0       1.0
*BOUNDARY_PRESCRIBED_MOTION_RIGID
         2         5         1         8
*LOAD_NODE_POINT
         7         3         7      -5.0
         8         6         7       2.5
*LOAD_NODE_SET
        10         1         8      10.0         3
*LOAD_BODY_Z
         8      9.81
*LOAD_SEGMENT_SET
        13         7       4.0
*LOAD_SEGMENT
         8       0.5       0.0         1         4         3         2
*INITIAL_VELOCITY
        10
       1.0       2.0       3.0
*INITIAL_VELOCITY_NODE
         7       0.5       0.0       0.0
*INITIAL_VELOCITY_GENERATION
         1         2       2.0       0.0       0.0       0.0
       0.0       0.0       0.0       0.0       0.0       1.0
*CONTACT_AUTOMATIC_SURFACE_TO_SURFACE_ID
         9between them
         1        12         3         2
      0.25       0.2       0.0       0.0       0.0         0       0.0   1.0E20
       1.0       1.0
{CUBE}\
       9             2.0             0.0             0.0       7       0
      10             2.0             1.0             0.0       4       7
      11             3.0             0.0             0.0
      12             3.0             1.0             0.0
      13             3.0             1.0             1.0
      14             2.5             0.0             0.0
      15             2.0             0.5             0.0
*ELEMENT_SOLID
       1       1       1       2       3       4       5       6       7       8
       2       1       9      11      12      10      13      13      13      13
*ELEMENT_SHELL_THICKNESS
       1       2       1       2       6       5
             1.0             1.0             2.0             2.0            45.0
*ELEMENT_SHELL
       2       2       9      11      12      12
*ELEMENT_BEAM
       1       3       1       9       5
*ELEMENT_MASS
       1       7             0.5
*ELEMENT_DISCRETE
       1       6       8      10
       2       6       7       0
*ELEMENT_SPH
      14       4            0.25
      15       4            -2.5
*ELEMENT_DISCRETE_SPHERE
      13       5             1.0             0.4             0.1
*END
What stands here is not read.
"""


@pytest.fixture
def deck(tmp_path: Path) -> Callable[..., Model]:
    """deck(text) reads a text as a deck; further files by name: deck(text, **{"part.k": text})."""

    def make(
        text: str | bytes, /, *, files: dict[str, str] | None = None, main: str = "deck.k", **options: bool
    ) -> Model:
        for name, content in (files or {}).items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content)
        path = tmp_path / main
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return read(path, **options)

    return make


@pytest.fixture
def cube() -> str:
    """The eight nodes of a unit cube as *NODE."""
    return CUBE


@pytest.fixture
def everything() -> str:
    """A deck with a little of all that is read."""
    return EVERYTHING

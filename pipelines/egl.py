"""Whether this machine can draw without a screen: asked in a child process, as VTK crashes where it cannot."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache

from zrno.pipelines.errors import Missing

INSTALL = "apt-get install -y --no-install-recommends libegl1 libgl1-mesa-dri"
_WINDOW = "VTK_DEFAULT_OPENGL_WINDOW"
_PROBE = """
from vtkmodules.vtkRenderingOpenGL2 import vtkEGLRenderWindow
window = vtkEGLRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(16, 16)
window.Render()
if window.SupportsOpenGL():
    print("draws")
"""


@cache
def can_draw() -> bool:
    """Whether VTK draws off screen through EGL here (takes about a second, once)."""
    probe = subprocess.run([sys.executable, "-c", _PROBE], capture_output=True, text=True, check=False)
    return probe.returncode == 0 and probe.stdout.strip().endswith("draws")


def require() -> None:
    """Have VTK draw through EGL; raises Missing with the line that installs it. To be called before VTK is imported."""
    if not can_draw():
        raise Missing(f"pictures need EGL for drawing without a screen; on Debian or Ubuntu: {INSTALL}")
    os.environ.setdefault(_WINDOW, "vtkEGLRenderWindow")

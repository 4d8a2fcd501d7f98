# SPDX-License-Identifier: Apache-2.0
"""The commands relief, relief-mesh, relief-bake, relief-view and relief-accuracy of the Python package.

They replace this process by the tool in the package. The module relief is not imported, so that they start fast.
"""
from __future__ import annotations

import os
import pathlib
import sys
from typing import NoReturn


def _become(name: str) -> NoReturn:
    os.execv(pathlib.Path(__file__).parent / "relief" / "bin" / name, [name, *sys.argv[1:]])


def accuracy() -> NoReturn:
    """Become relief-accuracy."""
    _become("relief-accuracy")


def bake() -> NoReturn:
    """Become relief-bake."""
    _become("relief-bake")


def driver() -> NoReturn:
    """Become relief."""
    _become("relief")


def mesh() -> NoReturn:
    """Become relief-mesh."""
    _become("relief-mesh")


def view() -> NoReturn:
    """Become relief-view."""
    _become("relief-view")

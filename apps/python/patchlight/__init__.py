"""Adaptive-meshing radiosity, one function a step; see the docstrings."""

from ._patchlight import *  # noqa: F403
from ._patchlight import __version__ as __version__

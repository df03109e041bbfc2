"""What is moored: description, MoorDyn v2 reader and checks. No numerics."""

from .description import COUPLED, FIXED, FREE, Environment, Line, LineType, Point, Scene
from .errors import SceneError

__all__ = ["COUPLED", "FIXED", "FREE", "Environment", "Line", "LineType", "Point", "Scene", "SceneError"]

"""What is moored: description, MoorDyn v2 reader and checks. No numerics."""

from .description import COUPLED, FIXED, FREE, Environment, Line, LineType, Point, Scene
from .errors import SceneError
from .moordyn import load_scene, parse_scene

__all__ = ["COUPLED", "FIXED", "FREE", "Environment", "Line", "LineType", "Point", "Scene", "SceneError", "load_scene", "parse_scene"]

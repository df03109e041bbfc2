"""Which files the graph may point a node at: those below the folders that it was started with.

Who starts a node may name any file. Who sets a parameter over the graph later is somebody else, perhaps: a scene is read, and told of in
/diagnostics where it is wrong, and a recording is written, with the rights of the node's user.
"""
import os
import tempfile

FILES = ("scene", "recording.path")     # parameters that name one


class Access:
    """Set up once, with the values at the start.

    folders: paths, separated as in PATH; "" for the working directory, the folders of the first scene and recording, and that for temporary
    files, which anybody may read and write anyway.
    """

    def __init__(self, scene="", recording="", folders=""):
        beside = [os.path.dirname(_whole(path)) for path in (scene, recording) if path]
        named = folders.split(os.pathsep) if folders else [".", tempfile.gettempdir(), *beside]
        self._started_with = {"scene": scene, "recording.path": recording}
        self.folders = tuple(dict.fromkeys(_whole(folder) for folder in named if folder))

    def check(self, name, path):
        """Raises ValueError when parameter `name` may not be set to a path."""
        if path and path != self._started_with[name] and not inside(path, self.folders):
            raise ValueError(f"{name} is '{path}', expected a file below {', '.join(self.folders)}: start the node with access.folders for others")

    def folders_of(self, scene):
        """Where the files lie that a scene may name: None, for anywhere, where the node was started with it."""
        return None if scene == self._started_with["scene"] else self.folders


def inside(path, folders):
    """Whether a path lies in or below one of the folders, links followed."""
    path = _whole(path)
    return any(os.path.commonpath((path, folder)) == folder for folder in folders)


def _whole(path):
    return os.path.realpath(os.path.expanduser(path))

"""The scene in a recording: the file itself, and each file that it was read from, as an attachment of its own."""
from typing import NamedTuple

from .errors import RecordingError

SCENE_MEDIA_TYPE = 'text/plain'
OTHER_MEDIA_TYPE = 'text/plain;role=scene-file'     # a file that the scene names


class AttachedScene(NamedTuple):
    """name: of the scene's file; text: its content; files: (name as written in the scene, content) of those that it was read from."""

    name: str
    text: str
    files: tuple = ()


def attachments(scene):
    """[(name, media type, bytes)] of an AttachedScene."""
    return [(scene.name or 'scene.txt', SCENE_MEDIA_TYPE, scene.text.encode()),
            *((name, OTHER_MEDIA_TYPE, text.encode()) for name, text in scene.files)]


def attached_scene(path, found):
    """The AttachedScene among the attachments (in their order) of the recording at `path`, or None. Raises RecordingError when it is no text."""
    scenes = [each for each in found if each.media_type == SCENE_MEDIA_TYPE]
    if not scenes:
        return None
    others = [each for each in found if each.media_type == OTHER_MEDIA_TYPE]
    return AttachedScene(scenes[0].name, _text(path, scenes[0]), tuple((each.name, _text(path, each)) for each in others))


def _text(path, attachment):
    try:
        return attachment.data.decode()
    except UnicodeDecodeError as error:
        raise RecordingError(f'{path}: attachment {attachment.name!r}: byte {error.start} is not UTF-8, expected the text of a scene') from error

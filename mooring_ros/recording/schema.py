"""Schema text (`ros2msg`) of message types, and their Python classes.

The text is derived from the message classes themselves: the `.msg` files are not installed
everywhere, the classes are.
"""
import functools
import importlib
import re

from .errors import RecordingError

SEPARATOR = '=' * 80
TYPE_NAME = re.compile(r'^([a-z][a-z0-9_]*)/msg/([A-Z][A-Za-z0-9]*)$')
# The classes speak IDL; `ros2msg` has names of its own for these.
MSG_NAME = {'double': 'float64', 'float': 'float32', 'boolean': 'bool', 'octet': 'byte'}
ARRAY = re.compile(r'^(?P<item>.*)\[(?P<size>\d+)\]$')
SEQUENCE = re.compile(r'^sequence<(?P<item>.*?)(?:, *(?P<bound>\d+))?>$')
BOUNDED_STRING = re.compile(r'^(w?string)<(\d+)>$')


@functools.lru_cache(maxsize=None)
def message_class(type_name):
    """The Python class of a type name such as `nav_msgs/msg/Odometry`.

    Raises RecordingError for a malformed name or a type that is not installed.
    """
    parts = TYPE_NAME.match(type_name)
    if not parts:
        raise RecordingError(f'message type {type_name!r}: expected PACKAGE/msg/NAME')
    package, name = parts.groups()
    try:
        return getattr(importlib.import_module(f'{package}.msg'), name)
    except (ImportError, AttributeError):
        raise RecordingError(f'message type {type_name!r} is not installed here: '
                             'expected a type of common_interfaces') from None


@functools.lru_cache(maxsize=None)
def schema_text(type_name):
    """Definition of a message type and of all types in it, joined as `ros2msg` wants it.

    type_name: `PACKAGE/msg/NAME`. Returns str. Raises RecordingError as `message_class` does.
    """
    needed = [type_name]
    for each in needed:                       # grows while it is walked: depth of nesting is no matter
        for field_type in _fields(each).values():
            item = _split(field_type)[0]
            if '/' in item and _full(item) not in needed:
                needed.append(_full(item))
    parts = [_definition(type_name)]
    parts += [f'{SEPARATOR}\nMSG: {each.replace("/msg/", "/")}\n{_definition(each)}' for each in needed[1:]]
    return ''.join(parts)


def _fields(type_name):
    return message_class(type_name).get_fields_and_field_types()


def _full(item):
    package, name = item.split('/')
    return f'{package}/msg/{name}'


def _split(field_type):
    """('sequence<double, 3>') -> ('double', '[<=3]')."""
    match = SEQUENCE.match(field_type)
    if match:
        bound = match['bound']
        return match['item'], f'[<={bound}]' if bound else '[]'
    match = ARRAY.match(field_type)
    if match:
        return match['item'], f'[{match["size"]}]'
    return field_type, ''


def _definition(type_name):
    lines = [f'{_constant_type(value)} {name}={_constant_value(value)}'
             for name, value in _constants(message_class(type_name)).items()]
    for name, field_type in _fields(type_name).items():
        item, brackets = _split(field_type)
        item = BOUNDED_STRING.sub(r'\1<=\2', MSG_NAME.get(item, item))
        lines.append(f'{item}{brackets} {name}')
    return ''.join(line + '\n' for line in lines)


def _constants(cls):
    return vars(type(cls)).get(f'_Metaclass_{cls.__name__}__constants', {})


def _constant_type(value):
    if isinstance(value, bool):
        return 'bool'
    if isinstance(value, bytes):
        return 'byte'
    if isinstance(value, int):
        return 'int32' if -2**31 <= value < 2**31 else 'int64' if value < 2**63 else 'uint64'
    return 'float64' if isinstance(value, float) else 'string'


def _constant_value(value):
    return value[0] if isinstance(value, bytes) else value

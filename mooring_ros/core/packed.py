"""Named tuples of arrays that kernels see through one pointer.

numba passes a tuple of arrays by value, every pointer, shape and stride of every array an argument of its own: with some hundred arrays a
call costs microseconds and a function seconds to compile. A class marked `packed` writes where its arrays lie into one row of words when a
kernel first needs it, and the kernel gets the address of that row; `tuple.field` in a kernel reads the few words of that field. Arrays may
change their values, not their place: tuples are immutable, and `_replace` makes a tuple with a row of its own.
"""

import struct
from functools import cached_property, lru_cache, wraps

import numba
import numpy as np
from numba.core import cgutils, types
from numba.core.extending import NativeValue, models, register_model, typeof_impl, unbox
from numba.core.imputils import lower_getattr_generic
from numba.core.typing.templates import AttributeTemplate, infer_getattr

_LAYOUTS = {}  # class -> {field: (numba type, first word)}, from the first tuple that is packed: all of a class have the same types


class Fields(types.Type):
    """Type of a packed tuple in a kernel."""

    def __init__(self, cls):
        self.cls = cls
        super().__init__(name=f"Fields({cls.__module__}.{cls.__qualname__})")

    @property
    def key(self):
        return self.cls


register_model(Fields)(lambda dmm, fe_type: models.PrimitiveModel(dmm, fe_type, cgutils.intp_t))


class _Packed:
    """What `packed` adds to a named tuple."""

    @cached_property
    def address(self):
        """Where the row of words is, an int."""
        self._row = _row(self)
        return self._row.ctypes.data


def packed(cls):
    """Let kernels see tuples of the named tuple `cls` through one pointer."""
    return type(cls.__name__, (_Packed, cls), {"__doc__": cls.__doc__, "__module__": cls.__module__, "__qualname__": cls.__qualname__})


def entry(dispatcher):
    """The kernel `dispatcher` for callers in Python that always give it the same types, arrays C-contiguous: they are looked at once only."""
    compiled = []

    def call(*args):
        if not compiled:
            result = dispatcher(*args)
            compiled.append(dispatcher.overloads[dispatcher.signatures[-1]].entry_point)
            return result
        return compiled[0](*args)

    call.dispatcher = dispatcher
    return wraps(dispatcher.py_func)(call)


def _words(value):
    """(numba type, words) of a field."""
    if isinstance(value, _Packed):
        return Fields(type(value)), value
    if isinstance(value, np.ndarray):
        if not value.flags.c_contiguous:
            raise ValueError(f"an array of shape {value.shape} is not contiguous")
        return _array_type(value.dtype, value.ndim, value.flags.writeable), [value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides]
    if isinstance(value, bool | np.bool_):
        return types.boolean, [int(value)]
    if isinstance(value, int | np.integer):
        return types.int64, [int(value)]
    if isinstance(value, tuple):
        return types.UniTuple(types.float64, len(value)), [_bits(part) for part in value]
    return types.float64, [_bits(value)]


@lru_cache(maxsize=None)
def _array_type(dtype, ndim, writeable):
    """That of contiguous arrays; numba.typeof takes longer than all else here."""
    return types.Array(numba.from_dtype(dtype), ndim, "C", readonly=not writeable)


def _bits(value):
    return struct.unpack("q", struct.pack("d", float(value)))[0]


def _row(values):
    """(words,) int64: all fields one after another; of a tuple within, where its own row is."""
    layout, words = {}, []
    for name, value in zip(values._fields, values):
        kind, part = _words(value)
        layout[name] = (kind, len(words))
        words += [part.address] if isinstance(part, _Packed) else part
    known = _LAYOUTS.setdefault(type(values), layout)
    if known != layout:
        raise TypeError(f"fields of {type(values).__name__} differ in type from those of another one")
    return np.array(words, dtype=np.int64)


@typeof_impl.register(_Packed)
def _typeof_packed(value, context):
    value.address  # noqa: B018  (its layout must be known before anything is compiled)
    return Fields(type(value))


@unbox(Fields)
def _unbox_packed(typ, obj, context):
    address = context.pyapi.object_getattr_string(obj, "address")
    native = context.unbox(types.int64, address)
    context.pyapi.decref(address)
    return NativeValue(native.value, is_error=native.is_error)


@infer_getattr
class _FieldsAttribute(AttributeTemplate):
    key = Fields

    def generic_resolve(self, typ, attr):
        found = _LAYOUTS[typ.cls].get(attr)
        return found[0] if found else None


@lower_getattr_generic(Fields)
def _get_field(context, builder, typ, value, attr):
    kind, first = _LAYOUTS[typ.cls][attr]
    word = cgutils.intp_t
    row = builder.inttoptr(value, word.as_pointer())

    def load(index):
        loaded = builder.load(builder.gep(row, [word(first + index)]))
        loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
        return loaded

    if isinstance(kind, types.Array):
        array = context.make_array(kind)(context, builder)
        array.meminfo = cgutils.get_null_value(array.meminfo.type)
        array.parent = cgutils.get_null_value(array.parent.type)
        array.nitems, array.itemsize = load(0), load(1)
        array.data = builder.inttoptr(load(2), array.data.type)
        array.shape = cgutils.pack_array(builder, [load(3 + k) for k in range(kind.ndim)])
        array.strides = cgutils.pack_array(builder, [load(3 + kind.ndim + k) for k in range(kind.ndim)])
        return array._getvalue()
    if kind == types.float64:
        return builder.bitcast(load(0), context.get_value_type(types.float64))
    if kind == types.boolean:
        return builder.trunc(load(0), cgutils.bool_t)
    if isinstance(kind, types.UniTuple):
        return context.make_tuple(builder, kind, [builder.bitcast(load(k), context.get_value_type(types.float64)) for k in range(kind.count)])
    return load(0)  # a whole number, or the row of a tuple within

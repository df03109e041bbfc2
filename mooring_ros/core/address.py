"""Packed tuples and kernels by their addresses: one kernel works through many moorings, and calls another one without compiling it anew."""

from numba.core import types
from numba.core.extending import intrinsic

from .packed import Fields


def tuple_at(cls):
    """Intrinsic: (address) -> the packed tuple of the class `cls` that is there."""

    @intrinsic
    def there(context, address):
        return Fields(cls)(types.int64), lambda codegen, builder, signature, args: args[0]

    return there


def caller(result, arguments):
    """Intrinsic: (address, *arguments) -> what the kernel there returns, of the numba type `result`; `arguments`: tuple of numba types."""

    @intrinsic
    def called(context, address, *given):
        def call(codegen, builder, signature, args):
            convention = codegen.call_conv
            values = [builder.extract_value(args[1], k) for k in range(len(arguments))]
            function = builder.inttoptr(args[0], convention.get_function_type(result, arguments).as_pointer())
            _, returned = convention.call_function(builder, function, result, arguments, values)
            return returned

        return result(types.int64, types.Tuple(arguments)), call

    return called


def address_of(kernel, result, arguments):
    """Where the `kernel`, compiled for `arguments`, is in this process. The packed tuples among them must have been packed once."""
    kernel.compile(arguments)
    made = kernel.overloads[arguments]
    if made.fndesc.restype != result:
        raise TypeError(f"{kernel.__name__} returns {made.fndesc.restype}; expected {result}")
    return made.library.get_pointer_to_function(made.fndesc.llvm_func_name)

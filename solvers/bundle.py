"""Named tuples of many arrays, which kernels are given by their place in memory.

numba hands on a tuple in parts: with 60 arrays each function has 400 arguments more, and whoever looks at one field
loads them all, which LLVM then takes apart again. That was half of the 20 seconds in which a step of particles is
compiled. Of a class that is a `bundle` kernels are given an address, and look up what they use. To its users nothing
changes: they write `arrays.x`, and a field that is None has no code.
"""

from __future__ import annotations

import struct
from typing import Any, TypeVar

import numpy as np
from llvmlite import ir
from numba import extending, types
from numba.core import cgutils
from numba.core.imputils import impl_ret_borrowed
from numba.core.typing.templates import AttributeTemplate

WORD = 8  # bytes; each field is a number of them
# as numba has it: owner, parent (neither: it is the caller's), size, size of an item, data; then shape and strides
ARRAY = "qqqqq"
KEPT = ("__doc__", "__module__", "__qualname__")


class Bundle(types.Type):  # type: ignore[misc]
    """The numba type of a bundle: its class and the types of its fields."""

    def __init__(self, tuple_class: type, fields: tuple[types.Type, ...]) -> None:
        self.tuple_class = tuple_class
        self.fields = dict(zip(tuple_class._fields, fields, strict=True))  # type: ignore[attr-defined]
        named = ", ".join(f"{name}: {field}" for name, field in self.fields.items())  # the type is what its name says
        super().__init__(name=f"{tuple_class.__module__}.{tuple_class.__qualname__}({named})")

    def place(self, name: str) -> int:
        """Words before a field."""
        names = list(self.fields)
        return sum(len(_format(self.fields[before])) for before in names[: names.index(name)])


def _format(field: types.Type) -> str:
    """What `struct` calls a field, a letter for each word."""
    if isinstance(field, types.Array):
        return ARRAY + 2 * int(field.ndim) * "q"
    if isinstance(field, types.Float):
        return "d"
    return "" if isinstance(field, types.NoneType) else "q"


def _pack(instance: Any) -> bytes:
    """The words of a bundle's fields, which it keeps."""
    try:
        return instance._words  # type: ignore[no-any-return]
    except AttributeError:
        pass
    words: list[int | float] = []
    letters = ["="]
    for value in instance:
        if isinstance(value, np.ndarray):
            words += (0, 0, value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides)
            letters += ARRAY, 2 * value.ndim * "q"
        elif value is not None:
            real = isinstance(value, float)
            words.append(value if real else int(value))
            letters.append("d" if real else "q")
    instance._words = struct.pack("".join(letters), *words)
    return instance._words  # type: ignore[no-any-return]


Class = TypeVar("Class", bound=type)


def bundle(tuple_class: Class) -> Class:
    """Decorator of a NamedTuple of arrays, float64, whole numbers and None, which kernels take by its address."""
    # the derived class has room for `_words`
    derived = type(tuple_class.__name__, (tuple_class,), {k: getattr(tuple_class, k) for k in KEPT})

    @extending.typeof_impl.register(derived)  # type: ignore[untyped-decorator]
    def typeof(value: Any, context: Any) -> Bundle:
        fields = tuple(extending.typeof_impl(field, context) for field in value)
        for name, field in zip(value._fields, fields, strict=True):
            whole = isinstance(field, types.Integer | types.Boolean)
            if not (whole or isinstance(field, types.Array | types.NoneType) or field == types.float64):
                raise TypeError(f"{derived.__name__}.{name} is {field}: a bundle does not hold that")
        return Bundle(derived, fields)

    return derived  # type: ignore[return-value]


@extending.register_model(Bundle)
class _Address(extending.models.OpaqueModel):  # type: ignore[misc]
    """An address; what is there belongs to the call from Python."""


@extending.infer_getattr
class _Fields(AttributeTemplate):  # type: ignore[misc]
    key = Bundle

    def generic_resolve(self, bundle: Bundle, name: str) -> types.Type | None:
        return bundle.fields.get(name)


@extending.lower_getattr_generic(Bundle)  # type: ignore[untyped-decorator]
def _look_up(context: Any, builder: Any, bundle: Bundle, address: Any, name: str) -> Any:
    field = bundle.fields[name]
    if isinstance(field, types.NoneType):
        return context.get_dummy_value()
    truth = isinstance(field, types.Boolean)
    kind = context.get_value_type(types.int64 if truth else field)
    at = cgutils.pointer_add(builder, address, ir.Constant(ir.IntType(64), bundle.place(name) * WORD))
    found = builder.load(builder.bitcast(at, kind.as_pointer()))
    # nothing writes there while a kernel runs: what is looked up in a loop can be looked up before it
    found.set_metadata("invariant.load", builder.module.add_metadata([]))
    if truth:
        found = builder.trunc(found, ir.IntType(1))
    return impl_ret_borrowed(context, builder, field, found)


@extending.unbox(Bundle)  # type: ignore[untyped-decorator]
def _unbox(bundle: Bundle, instance: Any, c: Any) -> extending.NativeValue:
    packer = c.pyapi.unserialize(c.pyapi.serialize_object(_pack))
    packed = c.pyapi.call_function_objargs(packer, (instance,))
    c.pyapi.decref(packer)
    failed = cgutils.is_null(c.builder, packed)
    address = cgutils.alloca_once_value(c.builder, packed)
    with c.builder.if_then(c.builder.not_(failed), likely=True):
        c.builder.store(c.pyapi.bytes_as_string(packed), address)
    return extending.NativeValue(c.builder.load(address), is_error=failed, cleanup=lambda: c.pyapi.decref(packed))

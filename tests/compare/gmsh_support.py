"""Gmsh's library by its C interface: the Python module is in a package of its own."""
import ctypes
import ctypes.util

_library = None


def available():
    return ctypes.util.find_library("gmsh") is not None


def call(name, *arguments):
    global _library
    if _library is None:
        _library = ctypes.CDLL(ctypes.util.find_library("gmsh"))
        call("gmshInitialize", 0, None, 0)
        call("gmshOptionSetNumber", b"General.Terminal", ctypes.c_double(0))
    error = ctypes.c_int()
    getattr(_library, name)(*arguments, ctypes.byref(error))
    if error.value:
        raise RuntimeError(f"{name}: error {error.value}")


def _array(kind):
    return ctypes.POINTER(kind)(), ctypes.c_size_t()


def _taken(array):
    return [array[0][i] for i in range(array[1].value)]


def open_file(path):
    """In place of what was open before."""
    call("gmshClear")
    call("gmshOpen", str(path).encode())


def write(path):
    call("gmshWrite", str(path).encode())


def surfaces():
    """Numbers and kinds."""
    pairs = _array(ctypes.c_int)
    call("gmshModelGetEntities", *map(ctypes.byref, pairs), 2)
    kinds = {}
    for number in _taken(pairs)[1::2]:
        kind = ctypes.c_char_p()
        call("gmshModelGetType", 2, number, ctypes.byref(kind))
        kinds[number] = kind.value.decode()
    return kinds


def nearest(surface, points):
    """The nearest points of a surface, nearly: those found are on it, to rounding."""
    numbers = (ctypes.c_double * (3 * len(points)))(*(float(x) for point in points for x in point))
    found, parameters = _array(ctypes.c_double), _array(ctypes.c_double)
    call("gmshModelGetClosestPoint", 2, surface, numbers, ctypes.c_size_t(len(numbers)),
         *map(ctypes.byref, found), *map(ctypes.byref, parameters))
    values = _taken(found)
    return [values[i:i + 3] for i in range(0, len(values), 3)]

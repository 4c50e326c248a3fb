"""Values on their way between a study and its workers, as bytes: numbers, texts, arrays, the classes below.

The format is pickle's. Bytes are data of others: a class or function that is not listed is refused, so that
none is called.
"""
import io
import pickle

from problems import RunFailure

KNOWN = {"plan": ("Case", "Comparison", "Plan", "Sweep"), "errors": ("ErrorMeasure",),
         "expressions": ("Expression",), "codes": ("Outcome",), "process": ("Cost",),
         "problems": ("RunFailure",), "results": ("Body", "Contact", "Run"), "pathlib": ("PosixPath",),
         "numpy": ("dtype", "ndarray"), "numpy.core.multiarray": ("_reconstruct", "scalar"),
         "numpy._core.multiarray": ("_reconstruct", "scalar")}
PROTOCOL = 4  # arrays of later ones need more functions


class Reader(pickle.Unpickler):
    def find_class(self, module, name):
        if name not in KNOWN.get(module, ()):
            raise pickle.UnpicklingError(f"{module}.{name}")
        return super().find_class(module, name)


def packed(value):
    return pickle.dumps(value, PROTOCOL)


def unpacked(data):
    """RunFailure: no such bytes."""
    try:
        return Reader(io.BytesIO(data)).load()
    except Exception as error:  # whatever the bytes lead to
        raise RunFailure(f"what was sent is nothing of a study: {error}") from error

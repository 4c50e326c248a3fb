"""Every fault that the linter knows, seeded into a sound scene; a module for each layer of cpp/lint."""
from seeded import body_faults  # noqa: F401
from seeded import contact_faults  # noqa: F401
from seeded import file_faults  # noqa: F401
from seeded import label_faults  # noqa: F401
from seeded import load_faults  # noqa: F401
from seeded import material_faults  # noqa: F401
from seeded import mesh_faults  # noqa: F401
from seeded import option_faults  # noqa: F401
from seeded.case import ELASTIC, FAULTS, SCENE, Case  # noqa: F401

"""mortier: contact of elastic and viscoplastic bodies on meshes that do not match (docs/python.md).

    scene = mortier.load("scene.toml", set={"time.steps": 20})
    run = scene.run()
    run.displacement["upper"], run.contact[0].pressure, run.history["contact_force"]
"""
from mortier._core import Contact, Step, version as __version__
from mortier.errors import Error, FreeMotion, InputError, OutputError, ResultMissing, StepError
from mortier.laws import forget_law, register_law
from mortier.meshes import Mesh
from mortier.run import Run
from mortier.scene import Fault, Scene, check, load
from mortier.stored import open_result as open

__all__ = ["Contact", "Error", "Fault", "FreeMotion", "InputError", "Mesh", "OutputError",
           "ResultMissing", "Run", "Scene", "Step", "StepError", "__version__", "check", "forget_law", "load",
           "open", "register_law"]

"""The package stays in step with the C++ interface; everything public is documented and annotated."""
import dataclasses
import importlib
import inspect
import os

import pytest

import drape
from drape import _drape


def public_callables():
    """Yields (name, object) of all public functions, classes, methods and properties."""
    for name in drape.__all__:
        value = getattr(drape, name)
        if not callable(value):
            continue
        yield name, value
        if inspect.isclass(value) and value.__module__.startswith("drape"):
            for member, function in vars(value).items():
                if member.startswith("_") and member != "__init__" or dataclasses.is_dataclass(value):
                    continue
                if isinstance(function, property):
                    yield f"{name}.{member}", function.fget
                elif inspect.isfunction(function):
                    yield f"{name}.{member}", function


def test_everything_public_has_a_docstring():
    names = [name for name, value in public_callables() if not inspect.getdoc(value)]
    assert names == []
    for module in ("drape", "drape.arrays", "drape.queries", "drape.settings", "drape.world"):
        assert importlib.import_module(module).__doc__


def test_every_argument_and_result_is_annotated():
    missing = []
    for name, value in public_callables():
        if inspect.isclass(value):
            continue
        signature = inspect.signature(value)
        if signature.return_annotation is inspect.Signature.empty:
            missing.append(name)
        missing += [f"{name}({argument})" for argument, parameter in signature.parameters.items()
                    if argument != "self" and parameter.annotation is inspect.Parameter.empty]
    assert missing == []
    assert os.path.exists(os.path.join(os.path.dirname(drape.__file__), "py.typed"))


def test_settings_have_the_fields_and_defaults_of_cpp():
    own = drape.Settings()._for_binding()
    assert own.pop("log") is drape.log_to_standard_error
    assert own == _drape.default_settings()
    for field in dataclasses.fields(drape.Settings):
        assert f"\n    {field.name}:" in drape.Settings.__doc__, field.name


def test_settings_docstring_names_every_choice():
    for name, numbers in _drape.choices().items():
        for choice in numbers:
            assert f'"{choice}"' in drape.Settings.__doc__, (name, choice)
            changed = dataclasses.replace(drape.Settings(), **{name: choice})
            assert changed._for_binding()[name] == numbers[choice]


def test_status_bits_are_those_of_cpp():
    own = {name: int(bit) for name, bit in drape.StepStatus.__members__.items() if bit}
    assert own == _drape.status_bits()
    assert drape.status_text(drape.StepStatus.GOOD) == ""
    assert ";" in drape.status_text(drape.StepStatus.CLOTHS_MEET | drape.StepStatus.DEVICE_FULL)
    assert int(drape.QueryLimits.CANDIDATES) == _drape.CANDIDATE_LIMIT
    assert int(drape.QueryLimits.ANSWERS) == _drape.ANSWER_LIMIT


@pytest.mark.parametrize("method, defaults", [("add_cloth", _drape.default_cloth()),
                                              ("add_mesh", _drape.default_obstacle())])
def test_defaults_of_arguments_are_those_of_cpp(method, defaults):
    parameters = inspect.signature(getattr(drape.ClothWorld, method)).parameters
    assert {name: list(parameters[name].default) if isinstance(default, list) else parameters[name].default
            for name, default in defaults.items()} == defaults


def test_settings_are_settings():
    for call in (drape.ClothWorld, drape.Queries, drape.why_no_device):
        with pytest.raises(TypeError, match="Settings"):
            call("host")
    settings = drape.Settings()
    with pytest.raises(AttributeError, match="devicee"):
        settings.devicee = "x"


def test_settings_that_cannot_be_used_raise():
    with pytest.raises(ValueError, match='Settings.mode is "?\'?fast.*"discrete", "continuous", "automatic"'):
        drape.Queries(drape.Settings(mode="fast"))
    with pytest.raises(TypeError, match="threads has the wrong type"):
        drape.Queries(drape.Settings(threads=-1))
    with pytest.raises(TypeError, match="Settings.log"):
        drape.Queries(drape.Settings(log=3))
    for make in (drape.Queries, drape.ClothWorld):
        with pytest.raises(ValueError, match="^Settings.activation is 9\nit should be 0 to 4$"):
            make(drape.Settings(backend="host", activation=9))
        with pytest.raises(drape.DeviceError, match="no OpenCL device matches"):
            make(drape.Settings(backend="opencl", device="there is no such device"))
    assert "there is no such device" in drape.why_no_device(drape.Settings(device="there is no such device"))
    assert drape.why_no_device(drape.Settings(backend="host")) == ""


def test_devices_and_version_are_named():
    assert drape.__version__ == os.environ["DRAPE_TEST_VERSION"]
    for device in drape.list_devices():
        assert set(device) == {"platform", "name", "driver", "is_gpu"}
    report = drape.Queries(drape.Settings(backend="host")).device
    assert report["on_host"] and report["device"]["name"] == "host"

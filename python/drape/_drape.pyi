from typing import Any

class DeviceError(RuntimeError): ...

VERSION: str

def __getattr__(name: str) -> Any: ...

from carom.formats.sdf.parts import Parts
from carom.formats.sdf.scene import SdfModel
def read_sensors(parts: Parts, model: SdfModel) -> None:
    pass

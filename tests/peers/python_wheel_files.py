"""What the installed package does with GDAL, fonts and OpenVDB: terrain, volume files, pictures, files of maps."""

import pathlib
import platform
import tempfile

import emscape as em
import numpy as np

scenario = em.load("scenarios/jacksboro.yaml", {"region.dims": [60, 60, 20]})
field = em.Solver(scenario, "cpu").at(70)
assert field.mask().any() and np.ptp(field.numpy()) > 0
picture = em.render(field, size=(320, 240))
assert picture.shape == (240, 320, 4) and np.ptp(picture) > 0

with tempfile.TemporaryDirectory() as temporary:
    folder = pathlib.Path(temporary)
    for name in ("field.vdb", "field.nvdb", "field.vti", "field.raw"):
        quantities = field.quantities[:1]
        field.write(folder / name, quantities)
        assert np.array_equal(em.read(folder / name).numpy(), field.numpy(), equal_nan=True), name
    louder = scenario.with_set({"emitters.jammer.power_w": 500})
    em.compare(
        scenario, louder, folder / "maps", heights="agl:100", cell_m=1000.0, products=["covered", "value"], times=70,
        formats=["cog", "png", "gpkg", "kmz", "czml", "nc"],
    )
    formats = {file.suffix for file in (folder / "maps" / "maps").iterdir()}
    assert {".tif", ".png", ".gpkg", ".kmz", ".czml", ".nc"} <= formats, formats

print(f"the wheel works with Python {platform.python_version()} and glibc {platform.libc_ver()[1]}")

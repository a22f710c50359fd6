"""What emscape coverage wrote, as GIS programs read it: GDAL's COG validator, GDAL, QGIS, and the conventions CF and CZML.

    map_files_test.py DIR cog|gdal|qgis|cf|czml     DIR: output of emscape coverage, in all formats; cf and cog: of compare
                                                    and study too
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import series

ROOT = pathlib.Path(__file__).resolve().parents[2]

FOLDER = pathlib.Path(sys.argv[1])
MAPS = FOLDER / "maps"
LAYERS = ("bands", "contours", "emitters", "sites", "tracks")


def leave_out(reason):
    """Ends the test as skipped, even where the peers are required: what it needs is no package of Debian."""
    print("skipped:", reason)
    sys.exit(series.SKIPPED)


def check_cog():
    """GDAL's validator takes every GeoTIFF."""
    try:
        from osgeo_utils.samples import validate_cloud_optimized_geotiff as validator
    except ImportError:
        series.skip("python3-gdal is not installed")
    files = sorted(MAPS.glob("*.tif"))
    series.check(files, "no GeoTIFF")
    for file in files:
        _, errors, _ = validator.validate(str(file), full_check=True)
        series.check(not errors, f"{file}: {errors}")


def check_gdal():
    """Every file opens; the layers and variables are there."""
    try:
        from osgeo import gdal, ogr
    except ImportError:
        series.skip("python3-gdal is not installed")
    gdal.UseExceptions()
    report = json.loads((FOLDER / "report.json").read_text())
    for one in report["maps"]:
        for file in one["files"]:
            if file.endswith(".tif"):
                dataset = gdal.Open(str(FOLDER / file))
                band = dataset.GetRasterBand(1)
                series.check(band.GetDescription() == one["description"], f"{file} is {band.GetDescription()}")
    package = ogr.Open(str(MAPS / "coverage.gpkg"))
    names = [package.GetLayer(n).GetName() for n in range(package.GetLayerCount())]
    series.check(set(LAYERS) <= set(names), f"layers {names}")
    products = {feature["product"] for feature in package.GetLayerByName("bands")}
    series.check({one["product"] for one in report["maps"]} == products, f"bands of {products}")
    overlays = ogr.Open(str(MAPS / "coverage.kmz"))
    series.check(overlays.GetLayerCount() > 0, "an empty KMZ")
    variables = gdal.OpenEx(str(MAPS / "coverage.nc"), gdal.OF_MULTIDIM_RASTER)
    root = variables.GetRootGroup()
    series.check("value_agl" in root.GetMDArrayNames(), f"variables {root.GetMDArrayNames()}")


def check_qgis():
    """QGIS opens the layers and finds their styles."""
    os.environ["QT_QPA_PLATFORM"] = "offscreen"
    try:
        from qgis.core import QgsApplication, QgsRasterLayer, QgsVectorLayer
    except ImportError:
        series.skip("python3-qgis is not installed")
    program = QgsApplication([], False)
    program.initQgis()
    for name in LAYERS:
        layer = QgsVectorLayer(f"{MAPS / 'coverage.gpkg'}|layername={name}", name, "ogr")
        series.check(layer.isValid() and layer.featureCount() > 0, f"layer {name} is not valid or empty")
        wanted = "RuleRenderer" if name in ("bands", "contours") else "singleSymbol"
        series.check(layer.renderer().type() == wanted, f"layer {name} is drawn by {layer.renderer().type()}")
        if wanted == "RuleRenderer":
            rules = layer.renderer().rootRule().children()
            series.check(sum(rule.active() for rule in rules) == 1, f"rules of {name} that are on")
    for file in [*MAPS.glob("*.tif"), f"NETCDF:{MAPS / 'coverage.nc'}:value_agl"]:
        layer = QgsRasterLayer(str(file), "map")
        series.check(layer.isValid() and layer.crs().authid() == "EPSG:32616", f"{file} in {layer.crs().authid()}")
    # Its destructors crash without exitQgis(), and on some systems with it.
    sys.stdout.flush()
    os._exit(0)


def check_cf():
    """compliance-checker and cfchecker (PyPI) find no fault by CF-1.8."""
    programs = ROOT / ".cache" / "peers" / "bin"
    if not (programs.parent / "installed.txt").exists():
        leave_out("compliance-checker and cfchecker are not installed; scripts/setup --peers does it with pip")
    files = sorted(FOLDER.rglob("*.nc"))
    series.check(files, "no netCDF file")
    for file in files:
        check_cf_of(programs, file)


def check_cf_of(programs, file):
    report = subprocess.run([programs / "compliance-checker", "--test=cf:1.8", "--criteria=strict", file],
                            capture_output=True, text=True)
    series.check(report.returncode == 0 and "All tests passed" in report.stdout, report.stdout + report.stderr)

    # The tables that cfchecker would fetch. The file has neither area types nor names of regions.
    names = next(programs.parent.rglob("cf-standard-name-table.xml"))
    with tempfile.TemporaryDirectory() as folder:
        tables = []
        for option, root in (("-a", "area_type_table"), ("-r", "standardized_region_list")):
            table = pathlib.Path(folder) / f"{root}.xml"
            table.write_text(f"<{root}><version_number>0</version_number><date>none</date></{root}>")
            tables += [option, table]
        report = subprocess.run([programs / "cfchecks", "-v", "1.8", "-s", names, *tables, file],
                                capture_output=True, text=True)
    faults = [line for line in report.stdout.splitlines() if line.startswith(("ERROR: ", "WARN: ", "FATAL: "))]
    series.check("ERRORS detected: 0" in report.stdout and not faults, "\n".join(faults) or report.stdout + report.stderr)


def check_czml():
    """The documents of emscape coverage and emscape export are valid by the JSON Schema of CZML."""
    try:
        from jsonschema import Draft7Validator, RefResolver
    except ImportError:
        series.skip("python3-jsonschema is not installed")
    shared = os.environ.get("EMSCAPE_REFERENCE_DIR") or pathlib.Path(__file__).resolve().parents[3] / "shared"
    schema = pathlib.Path(shared) / "reference" / "interop" / "czml" / "schema" / "Schema"
    if not schema.is_dir():
        leave_out("the schema of CZML is not in the repository")
    store = {}
    for file in schema.rglob("*.json"):
        try:
            content = json.loads(file.read_text())
        except ValueError:
            continue  # examples with comments
        if isinstance(content, dict):
            content.pop("$id", None)  # some do not agree with the folders
            store[file.resolve().as_uri()] = content
    root = (schema / "Document.json").resolve().as_uri()
    validator = Draft7Validator(store[root], resolver=RefResolver(root, store[root], store=store))
    for file in (MAPS / "coverage.czml", FOLDER.with_name(FOLDER.name + "_exported.czml")):
        errors = list(validator.iter_errors(json.loads(file.read_text())))
        series.check(not errors, f"{file}: " + "; ".join(f"{list(error.path)}: {error.message}" for error in errors[:3]))


{"cog": check_cog, "gdal": check_gdal, "qgis": check_qgis, "cf": check_cf, "czml": check_czml}[sys.argv[2]]()

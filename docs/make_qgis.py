#!/usr/bin/env python3
"""Draws images/qgis.png: what emscape coverage wrote, loaded into QGIS with the styles that come with it.

    docs/make_qgis.py [PROGRAM]      by default build/release/bin/emscape; needs python3-qgis (scripts/setup --peers)
"""

import os
import pathlib
import subprocess
import sys
import tempfile

os.environ["QT_QPA_PLATFORM"] = "offscreen"
from qgis.core import (QgsApplication, QgsCoordinateReferenceSystem, QgsHillshadeRenderer, QgsLayoutExporter, QgsLayoutItemLegend,
                       QgsLayoutItemMap, QgsLayoutItemScaleBar, QgsLayoutPoint, QgsLayoutSize, QgsPrintLayout, QgsProject, QgsRasterLayer,
                       QgsUnitTypes, QgsVectorLayer)

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGET = ROOT / "docs" / "images" / "qgis.png"
LAYERS = ("emitters", "sites", "tracks", "contours", "bands")  # from top to bottom
DPI = 110


def check(condition, message):
    if not condition:
        sys.exit(f"make_qgis: {message}")


def hillshade():
    layer = QgsRasterLayer(str(ROOT / "scenarios" / "data" / "jacksboro.tif"), "terrain")
    check(layer.isValid(), "the terrain cannot be read")
    shade = QgsHillshadeRenderer(layer.dataProvider(), 1, 315, 45)
    shade.setZFactor(1e-5)  # metres over degrees
    layer.setRenderer(shade)
    return layer


def millimetres(x, y):
    return QgsLayoutPoint(x, y, QgsUnitTypes.LayoutMillimeters)


def size(width, height):
    return QgsLayoutSize(width, height, QgsUnitTypes.LayoutMillimeters)


def draw(package):
    project = QgsProject.instance()
    layers = [QgsVectorLayer(f"{package}|layername={name}", name, "ogr") for name in LAYERS]
    for layer in layers:
        check(layer.isValid(), f"layer {layer.name()} is not valid")
        layer.loadDefaultStyle()
    area = layers[-1].extent()
    layers.append(hillshade())
    project.setCrs(QgsCoordinateReferenceSystem(layers[-2].crs()))
    for layer in layers:
        project.addMapLayer(layer, False)
        project.layerTreeRoot().addLayer(layer)

    layout = QgsPrintLayout(project)
    layout.initializeDefaults()
    layout.pageCollection().page(0).setPageSize(size(250, 170))
    view = QgsLayoutItemMap(layout)
    layout.addLayoutItem(view)
    view.attemptMove(millimetres(4, 4))
    view.attemptResize(size(162, 162))
    area.scale(1.02)
    view.setExtent(area)
    view.setLayers(layers)
    view.setFrameEnabled(True)
    legend = QgsLayoutItemLegend(layout)
    layout.addLayoutItem(legend)
    legend.setLinkedMap(view)
    legend.setLegendFilterByMapEnabled(True)
    legend.attemptMove(millimetres(170, 4))
    scale = QgsLayoutItemScaleBar(layout)
    layout.addLayoutItem(scale)
    scale.setStyle("Single Box")
    scale.setLinkedMap(view)
    scale.setUnits(QgsUnitTypes.DistanceKilometers)
    scale.setUnitLabel("km")
    scale.setUnitsPerSegment(5)
    scale.setNumberOfSegments(2)
    scale.setNumberOfSegmentsLeft(0)
    scale.attemptMove(millimetres(172, 148))

    settings = QgsLayoutExporter.ImageExportSettings()
    settings.dpi = DPI
    settings.generateWorldFile = False
    result = QgsLayoutExporter(layout).exportToImage(str(TARGET), settings)
    check(result == QgsLayoutExporter.Success, f"the picture cannot be written ({result})")


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "release" / "bin" / "emscape"
    application = QgsApplication([], True)
    application.initQgis()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "coverage", ROOT / "scenarios" / "jacksboro.yaml", "-o", folder, "--heights", "agl:100", "--products",
                        "value,covered", "--cell", "100", "--times", "80", "--format", "gpkg", "--quiet"],
                       check=True, stdout=subprocess.DEVNULL)
        draw(pathlib.Path(folder) / "maps" / "coverage.gpkg")
    # Its destructors crash without exitQgis(), and on some systems with it.
    sys.stdout.flush()
    os._exit(0)


main()

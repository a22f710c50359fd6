"""Draws a volume or a series with ParaView, without its window.

    emscape simulate scenarios/jacksboro.yaml -o out --format vti --times 40
    pvpython examples/paraview_volume.py out/jacksboro_0001.vti volume.png
"""
import sys

from paraview import simple


def main(volume_file: str, picture: str) -> None:
    reader = simple.OpenDataFile(volume_file)
    reader.UpdatePipeline()
    name = reader.PointData[0].Name
    low, high = reader.PointData[name].GetRange()
    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [640, 400]
    view.Background = [0.75, 0.8, 0.85]
    view.UseColorPaletteForBackground = 0
    shown = simple.Show(reader, view)
    shown.SetRepresentationType("Volume")
    simple.ColorBy(shown, ("POINTS", name))
    colors, opacities = simple.GetColorTransferFunction(name), simple.GetOpacityTransferFunction(name)
    colors.ApplyPreset("Viridis (matplotlib)", True)
    colors.RescaleTransferFunction(low, high)
    middle = low + 0.6 * (high - low)
    opacities.Points = [low, 0, 0.5, 0, middle, 0, 0.5, 0, high, 0.6, 0.5, 0]
    shown.Scale = [1, 1, 3]  # heights three times as large
    view.ResetCamera()
    camera = simple.GetActiveCamera()
    camera.Elevation(-50)
    simple.Render(view)
    simple.SaveScreenshot(picture, view)


if __name__ == "__main__":
    main(*sys.argv[1:3])

#!/usr/bin/env python3
"""Makes the files of docs/own-data.md: raw data as one downloads it, of a coast that does not exist.

    docs/make_own_data.py [FOLDER]        (default: own)

SRTM tiles of 3 arc seconds in ZIP archives (hills west of 0.85 deg E; the eastern tile is all void, as tiles of the
sea are), a GPX track, an NSMA antenna (.adf) and a sounding as the University of Wyoming lists it.
"""
import math
import pathlib
import struct
import sys
import zipfile

POSTS = 1201


def height_m(latitude_deg, longitude_deg):
    """Hills that fall to a coast."""
    inland = 0.85 - longitude_deg + 0.02 * math.sin(40 * latitude_deg)
    if inland <= 0:
        return 0
    hills = 1 + math.sin(60 * longitude_deg + 9 * latitude_deg) * math.cos(55 * latitude_deg)
    return round(min(1, inland / 0.1) * (40 + 180 * hills))


def write_tile(folder, name, height):
    latitude, longitude = int(name[1:3]), int(name[4:7])
    rows = []
    for row in range(POSTS):
        north = latitude + 1 - row / (POSTS - 1)
        rows.append(struct.pack(f">{POSTS}h", *(height(north, longitude + k / (POSTS - 1)) for k in range(POSTS))))
    with zipfile.ZipFile(folder / f"{name}.SRTMGL3.hgt.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(f"{name}.hgt", b"".join(rows))


def write_track(file):
    """An aircraft from the sea to the land, 200 m/s, from 200 to 550 m above sea level."""
    points = []
    for second in range(0, 201, 5):
        part = second / 200
        latitude, longitude = 50.5 - 0.06 * part, 1.22 - 0.56 * part
        points.append(f'<trkpt lat="{latitude:.6f}" lon="{longitude:.6f}"><ele>{200 + 350 * part:.0f}</ele>'
                      f"<time>2026-06-01T06:{second // 60:02}:{second % 60:02}Z</time></trkpt>")
    file.write_text('<?xml version="1.0"?>\n<gpx version="1.1" creator="logger"><trk><name>intruder</name><trkseg>\n'
                    + "\n".join(points) + "\n</trkseg></trk></gpx>\n")


def write_antenna(file):
    lines = ["REVNUM:,NSMA WG16.99.050", "ANTMAN:,Example", "MODNUM:,S-30", "GUNITS:,DBI/DBR", "MDGAIN:,30"]
    for plane, width in (("H", 3), ("V", 8)):
        lines += [f"PATCUT:,{plane}", "POLARI:,V/V", "NUPOIN:,721", "FSTLST:,-180,180"]
        for half in range(721):
            angle = -180 + half / 2
            lines.append(f"{angle:g},{-min(12 * (angle / width) ** 2, 30):.2f}")
    file.write_text("\n".join(lines + ["ENDFIL:,EOF"]) + "\n")


def write_sounding(file):
    file.write_text("""<HTML><H2>99999 EXA Example Observations at 06Z 01 Jun 2026</H2>
<PRE>
-----------------------------------------------------------------------------
   PRES   HGHT   TEMP   DWPT   RELH   MIXR   DRCT   SKNT   THTA   THTE   THTV
    hPa     m      C      C      %    g/kg    deg   knot     K      K      K
-----------------------------------------------------------------------------
 1013.0     10   16.0   13.0     82   9.36    240     12  288.1  314.7  289.8
 1000.0    120   15.4   12.6     83   9.23    245     14  288.6  314.8  290.2
  985.0    250   17.0    5.0     45   5.58    250     18  291.4  307.6  292.4
  925.0    790   13.4    1.4     44   4.60    255     20  293.0  306.6  293.8
  850.0   1510    8.2   -2.8     46   3.63    260     24  294.8  305.7  295.4
  700.0   3090   -1.5  -14.5     37   1.80    265     31  300.8  306.9  301.1
  500.0   5700  -17.3  -33.3     23   0.45    270     40  311.9  313.6  312.0
</PRE><H3>Station information and sounding indices</H3><PRE>
                           Station latitude: 50.60
                          Station longitude: 0.50
</PRE></HTML>
""")


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "own")
    (folder / "srtm").mkdir(parents=True, exist_ok=True)
    write_tile(folder / "srtm", "N50E000", height_m)
    write_tile(folder / "srtm", "N50E001", lambda north, east: -32768)
    write_track(folder / "intruder.gpx")
    write_antenna(folder / "radar.adf")
    write_sounding(folder / "sounding.txt")


if __name__ == "__main__":
    main()

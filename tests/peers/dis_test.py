#!/usr/bin/env python3
"""Decodes what `emscape export` writes as DIS with opendis, and compares the values with the scenario's.

    dis_test.py EMSCAPE FOLDER
"""
import math
import os
import pathlib
import struct
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PYTHON = ROOT / ".cache" / "peers" / "bin" / "python"
SKIPPED = 77
# The first platform of scenarios/jamming.yaml, and its radar.
LATITUDE_DEG, LONGITUDE_DEG = 36.27, -84.24167
FREQUENCY_HZ, POWER_W, LOSSES_DB, GAIN_DBI = 3.0e9, 2000, 2, 33.3


def datagrams(path):
    """(time, UDP payload) of a .pcap of raw IPv4 packets."""
    data = path.read_bytes()
    at = 24
    while at < len(data):
        seconds, microseconds, size, _ = struct.unpack("<IIII", data[at:at + 16])
        yield seconds + microseconds * 1e-6, data[at + 16 + 28:at + 16 + size]
        at += 16 + size


def check(name, value, expected, tolerance=0):
    if abs(value - expected) > tolerance:
        sys.exit(f"{name} is {value!r}, not {expected!r}")


def compare(path):
    from opendis.PduFactory import createPdu
    kinds = {}
    for time, payload in datagrams(path):
        pdu = createPdu(payload)
        check("the length of a PDU", pdu.length, len(payload))
        check("its version", pdu.protocolVersion, 7)
        past_hour = (pdu.timestamp >> 1) * 3600 / 2**31
        check("its timestamp (s past the hour)", math.remainder(past_hour - time, 3600), 0, 1e-5)
        kinds.setdefault(pdu.pduType, []).append(pdu)
    states = [pdu for pdu in kinds[1] if pdu.entityID.entityID == 1]
    state = states[0]
    place = state.entityLocation
    check("longitude", math.degrees(math.atan2(place.y, place.x)), LONGITUDE_DEG, 1e-8)
    geocentric_deg = math.degrees(math.atan2(place.z, math.hypot(place.x, place.y)))
    flattening = 1 / 298.257223563
    expected_deg = math.degrees(math.atan((1 - flattening)**2 * math.tan(math.radians(LATITUDE_DEG))))
    check("geocentric latitude", geocentric_deg, expected_deg, 1e-4)
    if bytes(state.marking.characters).rstrip(b"\0") != b"ridge site":
        sys.exit(f"the marking is {bytes(state.marking.characters)!r}")
    emission = [pdu for pdu in kinds[23] if pdu.emittingEntityID.entityID == 1][0]
    check("number of systems", len(emission.systems), 1)
    beam = emission.systems[0].beamRecords[0]
    check("length of the system's record (words)", emission.systems[0].systemDataLength, 18)
    data = beam.fundamentalParameterData
    check("frequency", data.frequency, FREQUENCY_HZ, 256)
    erp_dbm = 10 * math.log10(POWER_W) + 30 + GAIN_DBI - LOSSES_DB
    check("effective radiated power", data.effectiveRadiatedPower, erp_dbm, 1e-4)
    check("half sweep in azimuth", data.beamAzimuthSweep, math.pi, 1e-6)
    check("function of the beam", beam.beamFunction, 1)
    print(f"{sum(map(len, kinds.values()))} PDUs are equal")


def main():
    if sys.argv[1] == "--compare":
        return compare(pathlib.Path(sys.argv[2]))
    emscape, folder = sys.argv[1:]
    if not PYTHON.exists() or subprocess.run([PYTHON, "-c", "import opendis"], capture_output=True, check=False).returncode:
        print("skipped: opendis is not installed (scripts/setup --peers)")
        return 1 if os.environ.get("EMSCAPE_REQUIRE_PEERS") else SKIPPED
    os.makedirs(folder, exist_ok=True)
    capture = pathlib.Path(folder) / "jamming.pcap"
    subprocess.run([emscape, "export", ROOT / "scenarios" / "jamming.yaml", "-o", capture, "--force", "--quiet"], check=True)
    return subprocess.run([PYTHON, __file__, "--compare", capture], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""PDUs of DIS decoded by our reader, by opendis and by tshark: all fields that the reader uses are equal.

    dis_pdus_test.py DIS_VALUES opendis|tshark FOLDER random|recorded

random: PDUs of versions 5 to 7, packed here by the standard. recorded: those of public recordings in $EMSCAPE_REFERENCE_DIR/interop/dis
(by default `shared` beside the checkout): single PDUs (.raw), text logs of KDIS (.log), sessions of Disco (.session), captures (.pcap).
"""
import json
import math
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PYTHON = ROOT / ".cache" / "peers" / "bin" / "python"
SKIPPED = 77
COUNT = 10000


def single(value):
    """A number as 32 bits hold it."""
    return struct.unpack(">f", struct.pack(">f", value))[0]


class Maker:
    """Random values of a PDU, as our reader gives them, and its bytes."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def number(self, scale):
        return single(self.random.uniform(-scale, scale))

    def numbers(self, scale):
        return [self.number(scale) for _ in range(3)]

    def bits(self, count):
        return self.random.getrandbits(count)

    def entity(self):
        return [self.bits(16) for _ in range(3)]

    def kind(self):
        """An entity type: kind, domain, country, category, ..."""
        return [self.bits(16) if part == 2 else self.bits(8) for part in range(7)]

    def place(self):
        height_m, north, turn = self.random.uniform(6.3e6, 6.5e6), self.random.uniform(-1.5, 1.5), self.random.uniform(-3, 3)
        return [height_m * math.cos(north) * math.cos(turn), height_m * math.cos(north) * math.sin(turn), height_m * math.sin(north)]

    def state(self):
        marking = "".join(self.random.choice("ABCxyz-123") for _ in range(self.random.randrange(1, 12)))
        values = [1, self.entity(), self.bits(8), self.kind(), self.numbers(1e3), self.place(), self.numbers(3), self.bits(32),
                  self.random.randrange(10), self.numbers(50), self.numbers(1), marking]
        _, entity, force, kind, velocity, place, angles, appearance, algorithm, acceleration, turn, _ = values
        parts = self.random.randrange(4)
        body = struct.pack(">3HBB", *entity, force, parts)
        body += struct.pack(">BBHBBBB", *kind) + self.random.randbytes(8)
        body += struct.pack(">3f3d3fIB", *velocity, *place, *angles, appearance, algorithm) + self.random.randbytes(15)
        body += struct.pack(">3f3fB", *acceleration, *turn, 1) + marking.encode().ljust(11, b"\0") + self.random.randbytes(4)
        return values, body + b"".join(b"\0" + self.random.randbytes(15) for _ in range(parts))

    def beam(self):
        values = [self.bits(8), self.bits(16), [self.number(1e9) for _ in range(9)], self.random.randrange(1, 20),
                  [self.entity() for _ in range(self.random.randrange(4))]]
        number, index, figures, function, targets = values
        words = (52 + 8 * len(targets)) // 4
        body = struct.pack(">BBH10fBBBBI", words, number, index, *figures, self.number(100), function, len(targets), 0, 0, 0)
        for target in targets:
            body += struct.pack(">3HBB", *target, self.bits(8), self.bits(8))
        return values, body

    def emission(self):
        entity, event, change = self.entity(), self.bits(16), self.bits(1)
        systems, body = [], b""
        for _ in range(self.random.randrange(1, 4)):
            beams = [self.beam() for _ in range(self.random.randrange(1, 4))]
            bytes_of_beams = b"".join(packed for _, packed in beams)
            system = [self.bits(16), self.bits(8), self.bits(8), self.numbers(20), [values for values, _ in beams]]
            words = (20 + len(bytes_of_beams)) // 4
            body += struct.pack(">BBHHBB3f", words if words < 256 else 0, len(beams), 0, *system[:3], *system[3]) + bytes_of_beams
            systems.append(system)
        head = struct.pack(">3H3HBBH", *entity, *entity[:2], event, change, len(systems), 0)
        return [23, entity, event, bool(change), systems], head + body

    def transmitter(self):
        values = [25, self.entity(), self.bits(16), self.kind(), self.random.randrange(3), self.place(), self.numbers(20), 0,
                  self.bits(36), self.number(1e7), self.number(100), [self.bits(16) for _ in range(4)]]
        _, entity, radio, kind, state, place, relative, pattern, frequency, bandwidth, power, modulation = values
        body = struct.pack(">3HH", *entity, radio) + struct.pack(">BBHBBBB", *kind) + struct.pack(">BBH", state, 0, 0)
        body += struct.pack(">3d3fHH", *place, *relative, pattern, 0) + struct.pack(">Qff4H", frequency, bandwidth, power, *modulation)
        return values, body + struct.pack(">HHBBH", 0, 0, 0, 0, 0)

    def pdu(self):
        kind = self.random.choice([1, 1, 23, 25])
        values, body = {1: self.state, 23: self.emission, 25: self.transmitter}[kind]()
        family = {1: 1, 23: 6, 25: 4}[kind]
        head = struct.pack(">BBBBIHH", self.random.choice([5, 6, 7]), 1, kind, family, self.bits(32), 12 + len(body), 0)
        return values, head + body


def recorded_pdus(folder):
    """The PDUs of all files of a folder of a kind that our reader uses; a session may end in a torn record."""
    for path in sorted(folder.iterdir()):
        if path.suffix == ".raw":
            pdus = [path.read_bytes()]
        elif path.suffix == ".log":
            # Digits below 16 stand alone.
            pdus = [bytes(int(byte, 16) for byte in line.split()) for line in path.read_text().splitlines()[1::2]]
        elif path.suffix == ".session":
            pdus, data, at = [], path.read_bytes(), 0
            while at + 10 <= len(data):
                size = struct.unpack_from(">H", data, at + 8)[0]
                pdus.append(data[at + 10:at + 10 + size])
                at += 10 + size
        elif path.suffix == ".pcap":
            pdus, data, at = [], path.read_bytes(), 24
            while at + 16 <= len(data):
                size = struct.unpack_from("<I", data, at + 8)[0]
                pdus.append(data[at + 16 + 28:at + 16 + size])
                at += 16 + size
        else:
            continue
        # Only whole PDUs: of a torn one the decoders tell different parts.
        yield from (pdu for pdu in pdus if len(pdu) >= 12 and pdu[2] in TSHARK and len(pdu) >= struct.unpack_from(">H", pdu, 8)[0])


def write_capture(path, pdus):
    with path.open("wb") as file:
        file.write(struct.pack("<IHHIIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 101))
        for number, pdu in enumerate(pdus):
            packet = struct.pack(">BBHHHBBHII", 0x45, 0, 28 + len(pdu), number & 0xFFFF, 0x4000, 1, 17, 0, 0x7F000001, 0x7F000001)
            packet += struct.pack(">HHHH", 3000, 3000, 8 + len(pdu), 0) + pdu
            file.write(struct.pack("<IIII", number // 1000, number % 1000 * 1000, len(packet), len(packet)) + packet)


def flat(values):
    for value in values:
        yield from flat(value) if isinstance(value, list) else [value]


def compare(what, number, got, expected, relative=0.0):
    got, expected = list(flat(got)), list(flat(expected))
    if len(got) != len(expected):
        sys.exit(f"PDU {number}: {what} has {len(got)} values, not {len(expected)}")
    for ours, theirs in zip(got, expected):
        same = ours == theirs or (isinstance(ours, float) and abs(ours - theirs) <= relative * abs(theirs))
        if not same:
            sys.exit(f"PDU {number}: {what} has {ours!r}, not {theirs!r}")


def of_opendis(pdu):
    """The values of a PDU of opendis, in the order of ours."""
    entity = lambda i: [i.siteID, i.applicationID, i.entityID]
    kind = lambda t: [t.entityKind, t.domain, t.country, t.category, t.subcategory, t.specific, t.extra]
    vector = lambda v: [v.x, v.y, v.z]
    if pdu.pduType == 1:
        reckoning = pdu.deadReckoningParameters
        angles = pdu.entityOrientation
        marking = bytes(pdu.marking.characters).split(b"\0")[0].decode()
        return [1, entity(pdu.entityID), pdu.forceId, kind(pdu.entityType), vector(pdu.entityLinearVelocity), vector(pdu.entityLocation),
                [angles.psi, angles.theta, angles.phi], pdu.entityAppearance, reckoning.deadReckoningAlgorithm,
                vector(reckoning.entityLinearAcceleration), vector(reckoning.entityAngularVelocity), marking]
    if pdu.pduType == 23:
        systems = []
        for system in pdu.systems:
            beams = []
            for beam in system.beamRecords:
                d = beam.fundamentalParameterData
                figures = [d.frequency, d.frequencyRange, d.effectiveRadiatedPower, d.pulseRepetitionFrequency, d.pulseWidth,
                           d.beamAzimuthCenter, d.beamAzimuthSweep, d.beamElevationCenter, d.beamElevationSweep]
                targets = [entity(track.entityID) for track in beam.trackJamRecords]
                beams.append([beam.beamIDNumber, beam.beamParameterIndex, figures, beam.beamFunction, targets])
            emitter = system.emitterSystem
            systems.append([emitter.emitterName, emitter.emitterFunction, emitter.emitterIDNumber, vector(system.location), beams])
        return [23, entity(pdu.emittingEntityID), pdu.eventID.eventNumber, bool(pdu.stateUpdateIndicator), systems]
    modulation = pdu.modulationType
    return [25, entity(pdu.radioReferenceID), pdu.radioNumber, kind(pdu.radioEntityType), pdu.transmitState, vector(pdu.antennaLocation),
            vector(pdu.relativeAntennaLocation), pdu.antennaPatternType, pdu.frequency, pdu.transmitFrequencyBandwidth, pdu.power,
            [modulation.spreadSpectrum, modulation.majorModulation, modulation.detail, modulation.radioSystem]]


TSHARK = {
    1: ["dis.entity_id_site", "dis.entity_id_application", "dis.entity_id_entity", "dis.force_id",
        *[f"dis.entity_linear_velocity.{a}" for a in "xyz"], *[f"dis.entity_location.{a}" for a in "xyz"],
        "dis.entity_orientation.psi", "dis.entity_orientation.theta", "dis.entity_orientation.phi",
        *[f"dis.entity_linear_acceleration.{a}" for a in "xyz"], *[f"dis.entity_angular_velocity.{a}" for a in "xyz"],
        "dis.entity_marking"],
    23: ["dis.entity_id_site", "dis.event_number", "dis.electromagnetic.emitter.name", "dis.electromagnetic.emission.function",
         "dis.electromagnetic.emission.emitter_id_number", *[f"dis.electromagnetic.emission.location.{a}" for a in "xyz"],
         "dis.em.beam.id_number", "dis.em.beam.parameter_index", "dis.em.fund.frequency", "dis.em.fund.frequency_range",
         "dis.em.fund.effective_radiated_power", "dis.em.fund.pulse_repetition_freq", "dis.em.fund.pulse_width",
         "dis.em.fund.beam.azimuth_center", "dis.em.fund.beam.azimuth_sweep", "dis.em.fund.beam.elevation_center",
         "dis.em.fund.beam.elevation_sweep", "dis.electromagnetic.emission.beam.function"],
    25: ["dis.entity_id_site", "dis.entity_id_application", "dis.entity_id_entity", "dis.radio.radio_id", "dis.radio.transmit_state",
         *[f"dis.antenna_location.{a}" for a in "xyz"], *[f"dis.rel_antenna_location.{a}" for a in "xyz"],
         "dis.radio.frequency", "dis.transmit_freq_bandwidth", "dis.transmit_power"],
}


def for_tshark(values):
    """Our values in the order of TSHARK: a list a field, with a value an occurrence."""
    kind = values[0]
    if kind == 1:
        _, entity, force, _, velocity, place, angles, _, _, acceleration, turn, marking = values
        return [[v] for v in [*entity, force, *velocity, *place, *angles, *acceleration, *turn, marking]]
    if kind == 23:
        _, entity, event, _, systems = values
        beams = [beam for system in systems for beam in system[4]]
        sites = [entity[0]] + [target[0] for beam in beams for target in beam[4]]
        lists = [sites, [event]] + [[s[part] for s in systems] for part in range(3)]
        lists += [[s[3][axis] for s in systems] for axis in range(3)]
        lists += [[b[0] for b in beams], [b[1] for b in beams]]
        return lists + [[b[2][figure] for b in beams] for figure in range(9)] + [[b[3] for b in beams]]
    _, entity, radio, _, state, place, relative, _, frequency, bandwidth, power, _ = values
    return [[v] for v in [*entity, radio, state, *place, *relative, frequency, bandwidth, power]]


def compare_tshark(capture, ours):
    for kind, fields in TSHARK.items():
        command = ["tshark", "-r", capture, "-d", "udp.port==3000,dis", "-Y", f"dis.pdu_type=={kind}", "-T", "fields",
                   "-E", "separator=;", "-E", "aggregator=,", "-e", "frame.number"]
        for field in fields:
            command += ["-e", field]
        lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
        expected = [n for n, values in enumerate(ours) if values[0] == kind]
        if len(lines) != len(expected):
            sys.exit(f"tshark decodes {len(lines)} PDUs of type {kind}, not {len(expected)}")
        for number, line in zip(expected, lines):
            for field, text, values in zip(fields, line.split(";")[1:], for_tshark(ours[number])):
                theirs = text.split(",")
                if not isinstance(values[0], str):
                    theirs = [float(value) if isinstance(values[0], float) else int(value, 0) for value in theirs]
                # It prints 32-bit numbers with 6 significant digits.
                compare(f"field {field}, compared with tshark's,", number, list(values), theirs, 1e-5)


def compare_opendis(path):
    from opendis.PduFactory import createPdu
    text = pathlib.Path(path).read_text().splitlines()
    for number, line in enumerate(text):
        ours, pdu = json.loads(line)
        compare("the PDU, compared with opendis's,", number, ours, of_opendis(createPdu(bytes.fromhex(pdu))))
    print(f"{len(text)} PDUs are equal to opendis's")


def main():
    if sys.argv[1] == "--opendis":
        return compare_opendis(sys.argv[2])
    dis_values, peer, folder, kind = sys.argv[1:]
    has_opendis = PYTHON.exists() and not subprocess.run([PYTHON, "-c", "import opendis"], capture_output=True, check=False).returncode
    if not (has_opendis if peer == "opendis" else shutil.which("tshark")):
        print(f"skipped: {peer} is not installed (scripts/setup --peers)")
        return 1 if os.environ.get("EMSCAPE_REQUIRE_PEERS") else SKIPPED
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    if kind == "random":
        maker = Maker(7)
        made = [maker.pdu() for _ in range(COUNT)]
    else:
        recordings = pathlib.Path(os.environ.get("EMSCAPE_REFERENCE_DIR", ROOT.parent / "shared")) / "interop" / "dis"
        if not recordings.is_dir():
            print(f"skipped: {recordings} is not there")
            return SKIPPED
        made = [(None, pdu) for pdu in recorded_pdus(recordings)]
    capture = folder / f"{kind}.pcap"
    write_capture(capture, [pdu for _, pdu in made])
    lines = subprocess.run([dis_values, capture], capture_output=True, text=True, check=True).stdout.splitlines()
    ours = [json.loads(line) for line in lines]
    if len(ours) != len(made) or not made:
        sys.exit(f"our reader decodes {len(ours)} PDUs of {len(made)}")
    for number, (values, _) in enumerate(made):
        if values is not None:
            compare("the PDU", number, ours[number], values)
    if peer == "tshark":
        compare_tshark(capture, ours)
        print(f"{len(made)} PDUs are equal to tshark's")
        return 0
    pairs = folder / f"{kind}.jsonl"
    pairs.write_text("".join(json.dumps([values, pdu.hex()]) + "\n" for values, (_, pdu) in zip(ours, made)))
    return subprocess.run([PYTHON, __file__, "--opendis", pairs], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())

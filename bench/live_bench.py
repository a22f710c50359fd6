#!/usr/bin/env python3
"""Measures live streams on this computer.

    bench/live_bench.py EMSCAPE receive [--rate 50000] [--seconds 30] [--entities 1000]
        Entity State PDUs received and applied per second
    bench/live_bench.py EMSCAPE latency [--moves 20] [--base scenarios/jacksboro.yaml]
        time from a PDU that moves an emitter to the field that has it
    bench/live_bench.py EMSCAPE exercise [--entities 1000] [--emitters 50] [--rate 10] [--seconds 20]
        fields per second while all entities move and the emitters' entities tell their place at --rate, the others once a second
    bench/live_bench.py EMSCAPE picture [--moves 20] [--base scenarios/jacksboro.yaml]
        time from a PDU that moves an emitter to the picture that has it, in the window (needs a display)
"""
import argparse
import json
import math
import pathlib
import socket
import statistics
import struct
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PORT = 43000


def ecef(latitude_deg, longitude_deg, height_m):
    latitude, longitude = math.radians(latitude_deg), math.radians(longitude_deg)
    first = 6.69437999014e-3
    normal_m = 6378137 / math.sqrt(1 - first * math.sin(latitude)**2)
    return ((normal_m + height_m) * math.cos(latitude) * math.cos(longitude), (normal_m + height_m) * math.cos(latitude) * math.sin(longitude),
            (normal_m * (1 - first) + height_m) * math.sin(latitude))


def timestamp():
    return int(time.time() % 3600 / 3600 * 2**31) << 1 & 0xFFFFFFFF


def header(kind, length):
    return struct.pack(">BBBBIHH", 7, 1, kind, 1, timestamp(), length, 0)


def state(entity, marking, place, velocity=(0, 0, 0)):
    """Of an entity that stands, or moves along a straight line (m/s)."""
    algorithm = 2 if any(velocity) else 1
    body = struct.pack(">3HBB", 1, 1, entity, 1, 0) + struct.pack(">BBHBBBB", 1, 1, 225, 0, 0, 0, 0) + bytes(8)
    body += struct.pack(">3f3d3fIB15x", *velocity, *place, 0, 0, 0, 0, algorithm) + struct.pack(">6fB", *[0] * 6, 1)
    return header(1, 144) + body + marking.encode().ljust(11, b"\0")[:11] + bytes(4)


def listen(emscape, base, *options):
    command = [emscape, "live", "--dis", str(PORT), "--base", base, "--json", *options]
    program = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    json.loads(program.stdout.readline())  # it listens
    return program


def receive(arguments):
    program = listen(arguments.emscape, ROOT / "scenarios" / "quick.yaml", "--no-field", "--duration", str(arguments.seconds + 6))
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.connect(("127.0.0.1", PORT))
    pdus = [bytearray(state(n % 65536, f"E{n}", ecef(52 + n * 1e-5, 5, 100))) for n in range(arguments.entities)]
    sent, begin = 0, time.perf_counter()
    while (past_s := time.perf_counter() - begin) < arguments.seconds:
        for _ in range(int(past_s * arguments.rate) - sent):
            pdu = pdus[sent % len(pdus)]
            struct.pack_into(">I", pdu, 4, timestamp())
            sender.send(pdu)
            sent += 1
        time.sleep(0.0005)
    lines = [json.loads(line) for line in program.stdout]
    last = lines[-1]
    print(f"{sent} PDUs sent in {arguments.seconds} s ({sent / arguments.seconds:.0f}/s): {last['pdus']} received, {last['lost']} lost, "
          f"{last['bad']} bad, {last['entities']} entities")
    return 0 if last["pdus"] == sent else 1


def latency(arguments):
    program = listen(arguments.emscape, arguments.base, "--duration", str(arguments.moves + 4))
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.connect(("127.0.0.1", PORT))
    times = []
    fields = 0
    for move in range(arguments.moves):
        sender.send(state(1, arguments.platform, ecef(36.33 + 2e-4 * move, -84.19, 900)))
        line = json.loads(program.stdout.readline())
        if line["fields"] > fields and move > 1:
            times.append((line["latency_ms"], line["field_ms"]))
        fields = line["fields"]
    program.wait()
    print(f"{len(times)} moves of the platform {arguments.platform}: median {statistics.median(t for t, _ in times):.0f} ms from the PDU to the "
          f"field, of which {statistics.median(f for _, f in times):.0f} ms are the field")
    return 0


def emission(entity):
    """A radar that turns, 3 GHz and 90 dBm."""
    beam = struct.pack(">BBH10fBBBBI", 13, 1, 0, 3e9, 0, 90, 1000, 1, 0, math.pi, 0, 0, 0, 1, 0, 0, 0, 0)
    system = struct.pack(">BBHHBB3f", 18, 1, 0, 28665, 2, 1, 0, 0, 0) + beam
    return header(23, 28 + len(system)) + struct.pack(">3H3HBBH", 1, 1, entity, 1, 1, 1, 0, 1, 0) + system


def moving(entity, past_s):
    """The state of an entity that goes north at 20 m/s."""
    def place(at_s):
        return ecef(36.2 + entity % 40 * 0.004 + 20 * at_s / 111200, -84.3 + entity // 40 * 0.004, 900)

    here = place(past_s)
    velocity = [after - before for before, after in zip(here, place(past_s + 1))]
    return state(entity, f"E{entity}", here, velocity)


def exercise(arguments):
    program = listen(arguments.emscape, arguments.base, "--duration", str(arguments.seconds + 10))
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.connect(("127.0.0.1", PORT))
    begin, steps, sent = time.perf_counter(), 0, 0
    while (past_s := time.perf_counter() - begin) < arguments.seconds + 5:
        if past_s * arguments.rate < steps:
            time.sleep(0.001)
            continue
        second = steps % int(arguments.rate) == 0
        for entity in range(1, (arguments.entities if second else arguments.emitters) + 1):
            sender.send(moving(entity, past_s))
            if second and entity <= arguments.emitters:
                sender.send(emission(entity))
            sent += 1
        steps += 1
    lines = [json.loads(line) for line in program.stdout]
    between = [line for line in lines if line["emitters"] >= arguments.emitters and line["entities"] >= arguments.entities]
    first, last = between[0], between[-1]
    if first is last:
        sys.exit("fields take too long: more --seconds")
    rate = (last["fields"] - first["fields"]) / (last["t_s"] - first["t_s"])
    print(f"{last['entities']} entities, {last['emitters']} emitters, {sent / (arguments.seconds + 5):.0f} states/s, {last['lost']} lost: "
          f"{rate:.2f} fields/s of {statistics.median(line['field_ms'] for line in between):.0f} ms, "
          f"{statistics.median(line['latency_ms'] for line in between):.0f} ms from the last PDU to its field")
    return 0


class WindowLog:
    """The frames of the window's log, as they are written."""

    def __init__(self, path):
        self.path, self.rest = path, ""
        while not path.exists():
            time.sleep(0.01)
        self.file = path.open()

    def frame(self, accepts, seconds):
        """The first frame that is accepted; None after the time."""
        end = time.perf_counter() + seconds
        while time.perf_counter() < end:
            self.rest += self.file.read()
            *lines, self.rest = self.rest.split("\n")
            for line in map(json.loads, lines):
                if line["event"] == "frame" and accepts(line):
                    return line
            time.sleep(0.001)
        return None


def picture(arguments):
    path = pathlib.Path(tempfile.mkdtemp()) / "window.jsonl"
    program = subprocess.Popen([arguments.emscape, "view", arguments.base, "--dis", str(PORT), "--log", path])
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sender.connect(("127.0.0.1", PORT))
    log = WindowLog(path)
    frame = log.frame(lambda line: line["exact"], 60)
    times = []
    for move in range(arguments.moves):
        before, begin = frame["fields_computed"], time.perf_counter()
        sender.send(state(1, arguments.platform, ecef(36.33 + 2e-4 * move, -84.19, 900)))
        frame = log.frame(lambda line: line["fields_computed"] > before, 10) or sys.exit("no picture within 10 s")
        if move > 1:
            times.append(1000 * (time.perf_counter() - begin))
        frame = log.frame(lambda line: line["exact"], 10) or frame
        time.sleep(0.3)
    program.terminate()
    program.wait()
    print(f"{len(times)} moves of the platform {arguments.platform}: median {statistics.median(times):.0f} ms from the PDU to the picture on the "
          f"screen, longest {max(times):.0f} ms")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("emscape")
    parser.add_argument("what", choices=["receive", "latency", "exercise", "picture"])
    parser.add_argument("--rate", type=float)
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--emitters", type=int, default=50)
    parser.add_argument("--entities", type=int, default=1000)
    parser.add_argument("--moves", type=int, default=20)
    parser.add_argument("--base", default=ROOT / "scenarios" / "jacksboro.yaml")
    parser.add_argument("--platform", default="mast")
    arguments = parser.parse_args()
    is_receive = arguments.what == "receive"
    arguments.rate = arguments.rate or (50000 if is_receive else 10)
    arguments.seconds = arguments.seconds or (30 if is_receive else 20)
    return {"receive": receive, "latency": latency, "exercise": exercise, "picture": picture}[arguments.what](arguments)


if __name__ == "__main__":
    sys.exit(main())

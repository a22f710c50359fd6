#!/usr/bin/env python3
"""Measures `emscape live` on this computer: Entity State PDUs received and applied per second, and the time from a PDU that moves an
emitter to the field that has it.

    bench/live_bench.py EMSCAPE receive [--rate 50000] [--seconds 30] [--entities 1000]
    bench/live_bench.py EMSCAPE latency [--moves 20] [--base scenarios/jacksboro.yaml]
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


def state(entity, marking, place):
    body = struct.pack(">3HBB", 1, 1, entity, 1, 0) + struct.pack(">BBHBBBB", 1, 1, 225, 0, 0, 0, 0) + bytes(8)
    body += struct.pack(">3f3d3fIB15x", 0, 0, 0, *place, 0, 0, 0, 0, 1) + struct.pack(">6fB", *[0] * 6, 1)
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


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("emscape")
    parser.add_argument("what", choices=["receive", "latency"])
    parser.add_argument("--rate", type=float, default=50000)
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--entities", type=int, default=1000)
    parser.add_argument("--moves", type=int, default=20)
    parser.add_argument("--base", default=ROOT / "scenarios" / "jacksboro.yaml")
    parser.add_argument("--platform", default="mast")
    arguments = parser.parse_args()
    return receive(arguments) if arguments.what == "receive" else latency(arguments)


if __name__ == "__main__":
    sys.exit(main())

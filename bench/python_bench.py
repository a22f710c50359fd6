"""Times of the Python package's own part: python bench/python_bench.py (with emscape installed, or PYTHONPATH=build/cpu/python)."""

import subprocess
import sys
import threading
import time
import zlib

import emscape as em

DLPACK_DEVICES = {1: "host", 2: "CUDA"}


def microseconds(call, count):
    call()
    begin = time.perf_counter()
    for _ in range(count):
        call()
    return (time.perf_counter() - begin) / count * 1e6


def tell_gpu(scenario):
    """Time of getting an array of a field on a GPU, and its device according to DLPack."""
    try:
        solver = em.Solver(scenario, "cuda")
    except em.DeviceError as error:
        print(f"fields on a GPU: {error}")
        return
    update_s, copy_s = [], []
    for i in range(20):
        begin = time.perf_counter()
        field = solver.at(0.0, scenario.with_set({"emitters.radar.power_w": 1000 + i}))
        updated = time.perf_counter()
        values = field.numpy()
        update_s.append(updated - begin)
        copy_s.append(time.perf_counter() - updated)
    megabytes = values.nbytes / 1e6
    copy = min(copy_s)
    print(f"Solver.at() on a GPU                 {min(update_s) * 1e3:8.2f} ms (is_on_gpu: {field.is_on_gpu})")
    print(f"first Field.numpy(), from a GPU      {copy * 1e3:8.2f} ms: {megabytes:.1f} MB, {megabytes / copy / 1e3:.1f} GB/s")
    begin = time.perf_counter()
    array = field.dlpack()
    print(f"first Field.dlpack(), on a GPU       {(time.perf_counter() - begin) * 1e3:8.2f} ms")
    print(f"Field.dlpack() again                 {microseconds(field.dlpack, 20000):8.2f} us")
    try:
        import cupy
    except ImportError:
        print("cupy.from_dlpack(): no cupy")
    else:
        pointers = {cupy.from_dlpack(field).data.ptr for _ in range(3)} | {cupy.from_dlpack(array).data.ptr}
        print(f"cupy.from_dlpack(), pointers of 4    {len(pointers):8d}")
        print(f"cupy.from_dlpack()                   {microseconds(lambda: cupy.from_dlpack(array), 5000):8.2f} us")
    device_type, number = field.__dlpack_device__()
    print(f"device of Field.dlpack()             {DLPACK_DEVICES.get(device_type, device_type)} {number}")


def main():
    scenario = em.load("scenarios/quick.yaml")
    solver = em.Solver(scenario, "cpu")
    field = solver.at(0)
    print(f"Field.numpy()                        {microseconds(field.numpy, 20000):8.2f} us")
    print(f"Field.dlpack()                       {microseconds(field.dlpack, 20000):8.2f} us")
    # Nothing has changed, so nothing is computed: only the call and the snapshot take time.
    print(f"Solver.at(), nothing to compute      {microseconds(lambda: solver.at(0), 5000):8.2f} us")

    probe = "import time; t = time.perf_counter(); import emscape; print(time.perf_counter() - t, open('/proc/self/statm').read().split()[1])"
    runs = [subprocess.run([sys.executable, "-c", probe], check=True, capture_output=True, text=True).stdout.split() for _ in range(9)]
    seconds, pages = min(runs, key=lambda run: float(run[0]))
    print(f"import emscape                       {float(seconds) * 1e3:8.2f} ms, {int(pages) * 4 // 1024} MB")

    larger = scenario.with_set({"region.dims": [128, 128, 64]})

    def solve():
        own = em.Solver(larger, "cpu", threads=1)
        for i in range(10):
            own.at(0.0, larger.with_set({"emitters.radar.power_w": 1000 + i}))

    begin = time.perf_counter()
    solve()
    solve()
    one = time.perf_counter() - begin
    threads = [threading.Thread(target=solve) for _ in range(2)]
    begin = time.perf_counter()
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    print(f"two threads with a solver each       {one / (time.perf_counter() - begin):8.2f} times as fast as one after the other")

    tell_gpu(larger)

    from emscape import datasets

    for backend, count in (("cpu", 64), ("cuda", 1000)):
        data = datasets.VolumeDataset(count, 1, backend=backend)
        try:
            data.field(0)
        except em.DeviceError as error:
            print(f"labelled volumes of 64^3, {backend}: {error}")
            continue
        digests, begin = [], time.perf_counter()
        for volume, label in data:
            digests.append(zlib.crc32(label.tobytes(), zlib.crc32(volume.tobytes())))
        seconds = time.perf_counter() - begin
        again = datasets.VolumeDataset(count, 1, backend=backend)
        same = sum(digests[i] == zlib.crc32(again[i][1].tobytes(), zlib.crc32(again[i][0].tobytes())) for i in range(0, count, 8))
        print(f"labelled volumes of 64^3, {backend:4}       {count / seconds:8.1f} per second: {count} in {seconds:.1f} s; "
              f"{same} of {len(range(0, count, 8))} are the same bytes when made again")


if __name__ == "__main__":
    main()

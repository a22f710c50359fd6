"""The Debian packages hold what is installed, in Debian's places, and their programs run.

    package_test.py CPACK BUILD-FOLDER SOURCE-FOLDER WORK-FOLDER
"""

import pathlib
import re
import shutil
import subprocess
import sys

cpack, build, source, work = sys.argv[1], *(pathlib.Path(argument) for argument in sys.argv[2:])


def said(*command):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}")
    return result.stdout


def check(condition, message):
    if not condition:
        sys.exit(f"package_test: {message}")


for tool in ("dpkg-deb", "dpkg-shlibdeps", "gzip"):
    if shutil.which(tool) is None:
        print(f"skipped: {tool} is not installed")
        sys.exit(77)

shutil.rmtree(work, ignore_errors=True)
work.mkdir(parents=True)
said(cpack, "--config", build / "CPackConfig.cmake", "-D", f"CPACK_OUTPUT_FILE_PREFIX={work}",
     "-D", f"CPACK_PACKAGE_DIRECTORY={work}", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=zstd")  # quick
version = re.search(r"VERSION ([0-9.]+)", (source / "CMakeLists.txt").read_text().split("project(")[1])[1]
program = next(work.glob(f"emscape_{version}-1_*.deb"))
development = next(work.glob(f"libemscape-dev_{version}-1_*.deb"))

fields = {name: said("dpkg-deb", "--field", program, name).strip() for name in ("Package", "Version", "Depends", "Description")}
check(fields["Version"] == f"{version}-1", fields)
for package in ("libc6", "libgdal", "libopenvdb", "proj-data", "fonts-dejavu-core"):
    check(package in fields["Depends"], f"Depends lacks {package}: {fields['Depends']}")
check(fields["Description"].startswith("electromagnetic environment"), fields["Description"])
check(f"emscape (= {version}-1)" in said("dpkg-deb", "--field", development, "Depends"), "libemscape-dev does not depend on emscape")

for package in (program, development):
    for line in said("dpkg-deb", "--contents", package).splitlines():
        mode, owner = line.split()[:2]
        check(owner == "root/root", line)
        check(mode[5] == "-" and mode[8] == "-" or mode[0] == "l", f"writable by others: {line}")

said("dpkg-deb", "--extract", program, work / "root")
said("dpkg-deb", "--extract", development, work / "root-dev")
usr, usr_dev = work / "root" / "usr", work / "root-dev" / "usr"


def files_below(folder):
    return {str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_file()}


files, files_dev = files_below(usr), files_below(usr_dev)
shipped = {file for file in said("git", "-C", source, "ls-files", "scenarios").split() if not file.endswith(".py")} \
    if (source / ".git").exists() else {"scenarios/jacksboro.yaml"}
expected = {f"share/emscape/{file}" for file in shipped}
expected |= {f"share/man/man1/{page.name}.gz" for page in (build / "share" / "man").glob("*.1")}
expected |= {"share/bash-completion/completions/emscape", "share/zsh/vendor-completions/_emscape"}
expected |= {f"share/doc/emscape/{name}" for name in (
    "README.md", "CHANGELOG.md", "LICENSE", "emscape.cdx.json", "copyright", "changelog.Debian.gz", "docs/models.md",
    "docs/images/profile.png")}
expected |= {"lib/emscape/emscape_vdb.so"}
expected |= {f"bin/{name}" for name in ("emscape", "emscape-bench", "emscape-view") if (build / "bin" / name).exists()}
check(expected <= files, f"missing: {sorted(expected - files)}")
check(not {file for file in files if file.startswith(("include", "lib")) and not file.startswith("lib/emscape/")}, "emscape has files of libemscape-dev")

documents = usr / "share/doc/emscape"
broken = [f"{page.relative_to(documents)}: {link}" for page in documents.rglob("*.md")
          for link in re.findall(r"\]\(([^)#\s]+)", page.read_text()) if "://" not in link and not (page.parent / link).exists()]
check(not broken, f"links to files that are not installed: {broken}")

headers = {f"include/{file}" for file in files_below(source / "include")}
check(headers <= files_dev, f"missing: {sorted(headers - files_dev)}")
check(any(file.endswith("libemscape_emfield.a") for file in files_dev), "no libraries")
check(any(file.endswith("emscapeConfig.cmake") for file in files_dev), "no emscapeConfig.cmake")

# Only the system's libraries and data beside what is in the package.
run = usr / "bin" / "emscape"
check(f"emscape {version}\n" in said(run, "--version"), "version")
check(".debug_info" not in said("readelf", "--sections", "--wide", run), "not stripped")
said(run, "validate", usr / "share/emscape/scenarios/jacksboro.yaml")
said(run, "simulate", usr / "share/emscape/scenarios/quick.yaml", "-o", work / "out", "--times", "0", "--quiet")
check(str(source.resolve()).encode() not in run.read_bytes(), f"{run} names the source folder")

if shutil.which("mandoc"):
    for page in (build / "share" / "man").glob("*.1"):
        lint = subprocess.run(["mandoc", "-T", "lint", "-W", "error", page], capture_output=True, text=True)
        check(lint.returncode == 0, lint.stdout)
if shutil.which("zsh"):
    said("zsh", "-n", usr / "share/zsh/vendor-completions/_emscape")

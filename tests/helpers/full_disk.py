"""Commands on a disk that is full at the n-th write, each n in a process of its own; no tests.

Run as a program under LD_PRELOAD of the library of `SHIM`: `python -m tests.helpers.full_disk FOLDER < commands.json`.
"""

import ctypes
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path

from tests.helpers.command_line import call
from tests.helpers.invalid_input import file_contents

# Writes to files, not to terminals and pipes, fail with ENOSPC when none are left.
SHIM = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>
int writes_left = -1, has_failed = 0;
static int is_full(int file)
{
    struct stat status;
    if (writes_left < 0 || fstat(file, &status) || !S_ISREG(status.st_mode))
        return 0;
    if (writes_left-- > 0)
        return 0;
    writes_left = 0;
    has_failed = 1;
    errno = ENOSPC;
    return 1;
}
#define FAILING(name, parameters, arguments)                                         \\
    ssize_t name parameters                                                          \\
    {                                                                                \\
        static ssize_t(*real) parameters;                                            \\
        if (!real)                                                                   \\
            real = (ssize_t(*) parameters)dlsym(RTLD_NEXT, #name);                   \\
        return is_full(file) ? -1 : real arguments;                                  \\
    }
FAILING(write, (int file, const void *from, size_t count), (file, from, count))
FAILING(pwrite, (int file, const void *from, size_t count, off_t at), (file, from, count, at))
FAILING(pwrite64, (int file, const void *from, size_t count, off_t at), (file, from, count, at))
"""


def run(arguments: list[str], writes: int) -> tuple[object, str, str, bool]:
    """Status, stdout and stderr of a command, and whether a write failed, in a process forked from this one."""
    ours, theirs = os.pipe()
    if os.fork() == 0:
        left, failed = (ctypes.c_int.in_dll(ctypes.CDLL(None), name) for name in ("writes_left", "has_failed"))
        left.value = writes
        answer = call(*arguments)
        left.value = -1
        os.write(theirs, json.dumps([*answer, bool(failed.value)]).encode())
        os._exit(0)
    os.close(theirs)
    with os.fdopen(ours, "rb") as pipe:
        answer = pipe.read()
    os.wait()
    return tuple(json.loads(answer)) if answer else (None, "", "it ends without a word", True)


def faults(arguments: list[str], folder: Path) -> Iterator[tuple[int, object, str, list[str], object]]:
    """For n = 0, 1, ... until no write fails: n, status, stderr, files left or changed, and the status once more.

    The last is that of the same command on a disk with room again, which finds what the first has left.
    """
    before = file_contents(folder)
    for n in range(1000):
        status, _, err, has_failed = run(arguments, n)
        if not has_failed:
            return
        after = file_contents(folder)
        left = sorted(path.name for path in after if before.get(path) != after[path])
        yield n, status, err, left, run(arguments, -1)[0] if left else 0
        for path in file_contents(folder).keys() - before.keys():
            path.unlink()


if __name__ == "__main__":
    os.chdir(sys.argv[1])
    for name, command in json.load(sys.stdin).items():
        for fault in faults(command, Path.cwd()):
            print(json.dumps([name, *fault]), flush=True)

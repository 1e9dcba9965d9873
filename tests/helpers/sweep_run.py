"""`cuefem study` as a process of its own, which tests kill; no tests. The guard is for the workers it spawns."""

from cuefem.cli import main

if __name__ == "__main__":
    main()

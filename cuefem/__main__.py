"""`python -m cuefem` is the command `cuefem`."""

from cuefem.cli import main

if __name__ == "__main__":
    main(prog_name="cuefem")

"""Side by side: cuefem and what one would use instead, on the same cone, with the error and the seconds of each.

`python -m studies.accuracy.peers` writes peers.md and peers.png here, in some ten minutes, with the peers that this
Python has: scikit-fem always, and those of the following that are installed:

    pip install ngsolve openseespy sfepy ross-rotordynamics "plotly<6"
    apt-get install calculix-ccx libblas3

(openseespy is installed without libblas3 and then does not start.)

The others are skipped, and the output says so. A peer is one file; contest.py says how they are timed, report.py what
is printed.
"""

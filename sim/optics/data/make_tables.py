"""Writes observers.csv and illuminants.csv from colour-science (PyPI, BSD-3-Clause), 0.4.7.

    pip install colour-science && python make_tables.py
"""

import colour
import numpy as np

SOURCE = f"# CIE tables as published in colour-science {colour.__version__} (https://www.colour-science.org)"

observers = [
    colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"],
    colour.MSDS_CMFS["CIE 1964 10 Degree Standard Observer"],
]
with open("observers.csv", "w") as out:
    print(SOURCE, file=out)
    print("# Colour-matching functions, CIE 018:2019, 1 nm: 1931 2 degrees, 1964 10 degrees.", file=out)
    print("nm,x2,y2,z2,x10,y10,z10", file=out)
    for nm in range(380, 781):
        print(nm, *(f"{v:.9g}" for o in observers for v in o[nm]), sep=",", file=out)

names = ["A", "D50", "D65", "FL2", "FL8", "FL11"]
with open("illuminants.csv", "w") as out:
    print(SOURCE, file=out)
    print("# Relative spectral power, CIE 15, 5 nm.", file=out)
    print("nm", *names, sep=",", file=out)
    for nm in range(380, 781, 5):
        values = (np.atleast_1d(colour.SDS_ILLUMINANTS[n][nm])[0] for n in names)
        print(nm, *(f"{v:.9g}" for v in values), sep=",", file=out)

"""Small valid record files of every format, as text; loaded by the tests with `runpy`.

(The tests' import mode gives them no folder to import neighbours from.)
"""

import re

import numpy as np

VALUES = np.round(0.2 * np.sin(np.arange(43) * 0.7) * np.exp(-np.arange(43) / 30.0), 6)
"""Forty-three samples in g."""


def fields(values: np.ndarray, layout: str, per_line: int) -> str:
    rows = [values[at : at + per_line] for at in range(0, len(values), per_line)]
    return "\n".join("".join(layout.format(value) for value in row) for row in rows) + "\n"


def at2(values: np.ndarray = VALUES, **change: str) -> str:
    header = {
        "units": "ACCELERATION TIME SERIES IN UNITS OF G",
        "npts": f"NPTS= {len(values)}, DT= .0100 SEC,",
        **change,
    }
    body = fields(values, "{:15.7E}", 5)
    return f"A DATABASE\nSomewhere, 1/1/2000\n{header['units']}\n{header['npts']}\n{body}"


def columns(header: str = "t_s,a_g\n", separator: str = ",", dt: float = 0.01) -> str:
    rows = [f"{i * dt:.4f}{separator}{value:.6f}" for i, value in enumerate(VALUES)]
    return header + "\n".join(rows) + "\n"


def csmip(channels: int = 2) -> str:
    text = ""
    for number in range(1, channels + 1):
        text += f"CORRECTED ACCELEROGRAM   X       CHAN  {number}:  {90 * number} DEG     FROM\n"
        text += f"CHAN  {number}:  {90 * number} DEG\n   1   1\n   .041   .630\n"
        for kind, unit in (("ACCEL", "CM/SEC/SEC"), ("VELOC", "CM/SEC")):
            text += f" 43 POINTS OF {kind} DATA EQUALLY SPACED AT  .010 SEC.  (UNITS: {unit})\n"
            text += fields(number * 100.0 * VALUES, "{:10.3f}", 8)
        text += f"/&  ----------  END OF DATA FOR CHANNEL  {number}  ----------\n"
    return text


def cosmos(channels: int = 1, unit: str = "cm/sec2(04)", kind: str = "acceleration") -> str:
    text = ""
    for number in range(1, channels + 1):
        reals = np.full(100, -999.0)
        reals[61] = 10.0
        text += "Corrected acceleration    (Format v01.20 with 3 text lines) Src: none\n"
        text += f"Sta Cha:  {number}: 340 deg (Rcrdr Chan  1) Location: here\nlast text\n"
        text += " 100 Integer-header values follow on  10 lines, Format= (10I8)\n"
        text += fields(np.full(100, -999), "{:8d}", 10)
        text += " 100 Real-header values follow on  17 lines, Format= (6F13.6)\n"
        text += fields(reals, "{:13.6f}", 6)
        text += '  1 Comment line(s) follow, each starting with a "|":\n | none\n'
        text += f"   43  {kind} pts, approx   0 secs, units={unit},Format=(8F10.5)\n"
        text += fields(number * 100.0 * VALUES, "{:10.5f}", 8)
        text += f"/&  ----------  End of data for channel  {number}  ----------\n"
    return text


def smc(kind: int = 2, count: int = 43) -> str:
    integers, reals = np.full(48, -32768), np.full(50, 0.17e39)
    integers[16], reals[1] = count, 100.0
    text = f"{kind} CORRECTED ACCELEROGRAM\n*\n" + "text component=  360\n" * 9
    text += fields(integers, "{:10d}", 8) + fields(reals, "{:15.7E}", 5) + "| comment\n|\n"
    text += re.sub(r"E([+-])0(?=[0-9])", r"E\1", fields(100.0 * VALUES, "{:11.4E}", 8))
    return text


def knet(seconds: str = "0.43", scale: str = "3920(gal)/6182761") -> str:
    names = ["Origin Time", "Lat.", "Long.", "Depth. (km)", "Mag.", "Station Code"]
    names += ["Station Lat.", "Station Long.", "Station Height(m)", "Record Time"]
    entries = [(name, "1") for name in names]
    entries += [("Sampling Freq(Hz)", "100Hz"), ("Duration Time(s)", seconds), ("Dir.", "N-S")]
    entries += [("Scale Factor", scale), ("Max. Acc. (gal)", "1"), ("Last Correction", "1")]
    entries += [("Memo.", "")]
    text = "".join(f"{name:<18}{value}\n" for name, value in entries)
    counts = np.round(VALUES * 980.665 * 6182761 / 3920).astype(int) + 2000
    return text + fields(counts, " {:8d}", 8)


def usc() -> str:
    text = "FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:\nNO. OF POINTS =   43  X\n"
    text += "UNITS ARE SEC AND G/10\nRMS ACCLN. OF COMPLETE RECORD =     .400 G/10\n"
    text += fields(np.zeros(100, int), "{:5d}", 16) + fields(np.zeros(50), "{:10.3f}", 8)
    times = np.cumsum(0.004 + 0.001 * (np.arange(43) % 2)) - 0.004
    pairs = np.column_stack((times, 10.0 * VALUES)).ravel()
    return text + re.sub("^", " ", fields(pairs, "{:7.3f}", 10).rstrip(), flags=re.M) + "\n"


SAMPLES = {
    "at2": at2(),
    "csv": columns(),
    "csmip": csmip(1),
    "cosmos": cosmos(),
    "smc": smc(),
    "knet": knet(),
}

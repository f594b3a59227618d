"""Small made-up record files as agencies write them, as text; loaded by the tests with `runpy`."""

import gzip
import re

import numpy as np

N = 40
G = 980.665
WAVE = np.round(np.sin(np.arange(N) * 0.7) * np.exp(-np.arange(N) / 30.0) * 0.2 * G, 4)
"""Forty samples in cm/s2."""
PEAK = float(np.max(np.abs(WAVE)))


def fields(values: np.ndarray, layout: str, per_line: int) -> str:
    rows = [values[at : at + per_line] for at in range(0, len(values), per_line)]
    return "\n".join("".join(layout.format(value) for value in row) for row in rows) + "\n"


def cosmos(
    data: str = "acceleration pts, approx   0 secs, units=cm/sec2(04),Format=(8F10.4)",
    values: str = fields(WAVE, "{:10.4f}", 8),
    end: str = "/&  ----------  End of data for channel  1  ----------\n",
    azimuth: int = 90,
    flag: int = 0,
    label: str = "90 Deg",
) -> str:
    integers, reals = np.full(100, -999), np.full(100, -999.0)
    integers[53], integers[75], reals[61] = azimuth, flag, 10.0
    return (
        "Uncorrected acceleration  (Format v01.20 with 2 text lines) Src: none\n"
        f"Sta Chan   1: {label} (Rcrdr Chan  1) Location:\n"
        " 100 Integer-header values follow on  10 lines, Format= (10I8)\n"
        + fields(integers, "{:8d}", 10)
        + " 100 Real-header values follow on  20 lines, Format= (5F15.6)\n"
        + fields(reals, "{:15.6f}", 5)
        + '   1 Comment line(s) follow, each starting with a "|":\n| made up\n'
        + f"      {N} {data}\n{values}{end}"
    )


def smc_wide(kind: str = "2 CORRECTED ACCELEROGRAM", flag: int = -32768, angle: int = 90) -> str:
    integers, reals = np.full(48, -32768), np.full(50, 1.7e38)
    integers[12], integers[16], integers[17], reals[1] = angle, N, flag, 100.0
    return (
        f"{kind}\n*\n" + "station = A   component=   UP\n" * 9
        + fields(integers, "{:10d}", 8) + fields(reals, "{:15.7E}", 5)
        + "|made up\n" + fields(WAVE, "{:14.7E}", 5)
    )  # fmt: skip


def dyna(**change: str) -> str:
    header = {
        "NETWORK": "XX",
        "SAMPLING_INTERVAL_S": "0.010000",
        "NDATA": str(N),
        "STREAM": "HNE",
        "UNITS": "cm/s^2",
        "PGA_CM/S^2": f"{-PEAK:.4f}",
        "DATA_TYPE": "ACCELERATION",
        "USER5": "",
    } | {key.replace("_per_", "/"): value for key, value in change.items()}
    return "".join(f"{key}: {value}\n" for key, value in header.items()) + fields(WAVE, "{:.6f}", 1)


def nsmn(count: int = N) -> str:
    rows = "".join(f"{a:14.6f}{-0.5 * a:14.6f}{0.25 * a:14.6f}\n" for a in WAVE)
    return (
        "STRONG GROUND MOTION RECORDS OF TURKIYE\nPLACE : X\n"
        f"NUMBER OF DATA          : {count}\nSAMPLING INTERVAL (sec) : 0.01\n"
        f"RAW PGA VALUES (gal)    : (N-S) {PEAK:.4f} (E-W) {0.5 * PEAK:.4f} (U-D) 99.0\n"
        f"       N-S          E-W          U-D\n{rows}"
    )


def geonet(corrected: bool = True, components: tuple[str, ...] = ("N28W", "Up")) -> str:
    text = ""
    for place, name in enumerate(components, 1):
        values = WAVE * 10.0 / place
        reals = np.zeros(60)
        reals[24], reals[25] = (0.01, 0.02) if not corrected else (0.005, 0.01)
        lines = [f"{'C' if corrected else 'Unc'}orrected accelerogram 2001_AAAA GNS Science"]
        lines += ["Site AAAA"] * 8
        lines += [f"Number of points  {N}    Duration {(N - 1) * 0.01:.2f} sec"]
        lines += ["Instrument corrected data at 0.010 sec intervals" if corrected else "raw"]
        lines += ["Band-pass", f"Component {name}  Longitudinal Accelerometer Axis"]
        lines += [f"Acceleration:  peak {PEAK * 10 / place:8.1f} mm/s/s at 1.5 sec"]
        lines += ["Velocity:  peak 1 mm/s", "Displacement: peak 1 mm"]
        text += "\n".join(lines) + "\n"
        text += fields(np.zeros(40, int), "{:8d}", 10) + fields(reals, "{:8.3f}", 10)
        text += fields(values, "{:8.1f}", 10) * (3 if corrected else 1)
    return text


def knet_csv(rate: str = "100", rows: int = N) -> str:
    text = "#Origin Time, 2024/08/08 16:43:00\n#Station Code, AAA001\n"
    text += f"#Sampling Freq(Hz), {rate}\n#Time, NS(gal), EW(gal), UD(gal)\n"
    for i, a in enumerate(WAVE[:rows]):
        text += f"2024/12/31 23:59:{59 + i / 100:05.2f},{a:.4f},{-0.5 * a:.4f},{0.25 * a:.4f}\n"
    # the record runs over midnight and the year's end
    return re.sub(r"2024/12/31 23:59:6([0-9])", r"2025/01/01 00:00:0\1", text)


def jma_csv() -> bytes:
    text = "SITE CODE= 93051\u76ca\u57ce,32.8,130.8,,,,,\n LAT.=   32.8,,,\n LON.=  130.8,,,\n"
    text += " SAMPLING RATE= 100Hz,,,\n UNIT  = gal(cm/s/s),,,\n"
    text += "INITIAL TIME = 2016 04 14 21 26 20,,,\n NS,EW,UD,,,,,\n"
    text += "".join(f"{a:.4f},{-0.5 * a:.4f},{0.25 * a:.4f},,,,,\n" for a in WAVE)
    return text.encode("shift_jis")


def renadic(uneven: bool = False) -> str:
    text = ""
    time = np.arange(N) * 0.01 + (0.003 * (np.arange(N) % 2) if uneven else 0.0)
    for number, name in enumerate(("EW", "V"), 1):
        values = WAVE * 10.0 / G / number
        text += "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 01/01/2001\n"
        text += f"CHAN  {number}: {name}       (STA CHN:  {number})\n"
        text += f"NO. OF POINTS =   {N}  RECORD LENGTH = 0.4 SEC\n"
        text += "UNITS OF UNCOR ACCEL ARE SEC AND G/10.     "
        text += f"MAX  = {PEAK / G / number:6.3f} G, AT 0.1 SEC\n"
        text += "RMS ACCEL OF COMPLETE RECORD = 0.010 G\n"
        text += fields(np.zeros(100, int), "{:5d}", 16) + fields(np.zeros(50), "{:10.3f}", 8)
        text += fields(np.column_stack((time, values)).ravel(), "{:7.3f}", 10)
        text += f"/&  ----------  END OF DATA FOR CHANNEL {number}  ----------\n"
    return text


packed = gzip.compress

"""Writes records in the formats of other programs, for docs/results/files.md.

    python -m venv venv && venv/bin/pip install numpy scipy pandas pyarrow h5py
    venv/bin/python tests/files/make.py FOLDER

Every file holds the same record, u = sin(0.3 k), y = cos(0.2 k) at t = 0.02 k s, k = 0..49,
as far as its format lets it.
"""

import gzip
import pickle
import struct
import sys
import wave
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import scipy.io

out = Path(sys.argv[1])
out.mkdir(parents=True, exist_ok=True)
n, step = 50, 0.02
t = step * np.arange(n)
u, y = np.sin(0.3 * np.arange(n)), np.cos(0.2 * np.arange(n))
frame = pd.DataFrame({"time": t, "u": u, "y": y})


def text(name, content, encoding="utf-8"):
    (out / name).write_bytes(content.encode(encoding))


def rows(separator=",", decimal=".", times=t, keep=range(n)):
    cell = lambda v: f"{v:.6f}".replace(".", decimal)
    return "".join(separator.join([cell(times[k]), cell(u[k]), cell(y[k])]) + "\n" for k in keep)


# NumPy
np.savez(out / "named.npz", time=t, u=u, y=y)
np.savez(out / "step.npz", u=u, y=y, Ts=step)
np.savez_compressed(out / "packed.npz", u=u[:, None], y=np.stack([y, -y], axis=1), fs=1 / step)
np.savez(out / "turned.npz", time=t, u=u[None, :], y=np.stack([y, -y]))
np.savez(out / "experiments.npz", u=np.stack([u, 2 * u])[:, :, None], y=np.stack([y, 2 * y])[:, :, None], Ts=step)
np.savez(out / "f32_i16.npz", u=u.astype("f4"), y=(1000 * y).astype("i2"), Ts=step)
np.savez(out / "f16.npz", u=u.astype("f2"), y=y.astype("f2"), Ts=step)
np.savez(out / "extras.npz", time=t, u=u, y=y, note=np.array("monday"), gains=np.ones((3, 3)))
np.savez(out / "objects.npz", u=np.array([u, None], dtype=object), y=y)
np.savez(out / "complex.npz", u=u + 1j, y=y)
np.savez(out / "datetime.npz", time=np.datetime64("2026-05-01T12:00:00", "ns") + (t * 1e9).round().astype("m8[ns]"), u=u, y=y)
np.save(out / "matrix.npy", np.stack([t, u, y], axis=1))
np.save(out / "fortran.npy", np.asfortranarray(np.stack([t, u, y], axis=1)))
np.save(out / "big_endian.npy", np.stack([t, u, y], axis=1).astype(">f8"))
np.save(out / "fields.npy", np.array(list(zip(t, u, y)), dtype=[("time", "f8"), ("u", "f8"), ("y", "f4")]))
np.save(out / "objects.npy", np.array([{"u": 1}], dtype=object))
(out / "cut.npy").write_bytes((out / "matrix.npy").read_bytes()[:-7])
(out / "packed.npy.gz").write_bytes(gzip.compress((out / "fields.npy").read_bytes()))

# MATLAB
scipy.io.savemat(out / "v7.mat", {"time": t, "u": u, "y": y}, do_compression=True)
scipy.io.savemat(out / "v5.mat", {"time": t[:, None], "u": u[:, None], "y": y[:, None]})
scipy.io.savemat(out / "v4.mat", {"time": t, "u": u, "y": y}, format="4")
scipy.io.savemat(out / "struct.mat", {"data": {"u": u, "y": np.stack([y, -y], axis=1), "Ts": step}})
cells = lambda *names: np.array([[name] for name in names], dtype=object)
scipy.io.savemat(
    out / "iddata_like.mat",
    {"z": {"InputData": u[:, None], "OutputData": y[:, None], "Ts": 20.0, "TimeUnit": "milliseconds",
           "InputName": cells("torque"), "OutputName": cells("angle"), "InputUnit": cells("N m"), "OutputUnit": cells("rad")}},
)
both = np.zeros((1, 2), dtype=[("u", "O"), ("y", "O"), ("Ts", "O")])
both[0, 0], both[0, 1] = (u, y, step), (2 * u, 2 * y, step)
scipy.io.savemat(out / "struct_array.mat", {"runs": both})
scipy.io.savemat(out / "two_structs.mat", {"est": {"u": u, "y": y, "Ts": step}, "val": {"u": -u, "y": -y, "Ts": step}})
scipy.io.savemat(out / "integers.mat", {"u": (1000 * u).astype("i2"), "y": (1000 * y).astype("i4"), "Ts": step})
scipy.io.savemat(out / "complex.mat", {"u": u + 1j, "y": y, "Ts": step})
scipy.io.savemat(out / "texts.mat", {"u": u, "y": y, "Ts": step, "note": "monday", "list": cells("a", "b")})
(out / "cut.mat").write_bytes((out / "v5.mat").read_bytes()[:700])


def big_endian_v5():
    def element(kind, data):
        return struct.pack(">II", kind, len(data)) + data + b"\0" * (-len(data) % 8)

    def matrix(name, values):
        body = element(6, struct.pack(">II", 6, 0)) + element(5, struct.pack(">ii", len(values), 1))
        body += element(1, name.encode()) + element(9, values.astype(">f8").tobytes())
        return element(14, body)

    head = b"MATLAB 5.0 MAT-file, Platform: SOL2".ljust(116) + b"\0" * 8 + struct.pack(">H", 0x0100) + b"MI"
    (out / "big_endian.mat").write_bytes(head + b"".join(matrix(k, v) for k, v in [("time", t), ("u", u), ("y", y)]))


big_endian_v5()
with h5py.File(out / "v73_body.h5", "w") as f:
    f["u"], f["y"] = u, y
body = (out / "v73_body.h5").read_bytes()
(out / "v73.mat").write_bytes(b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Fri May  1 12:00:00 2026 HDF5 schema 1.00 .".ljust(512, b"\0") + body)

# tables
frame.to_csv(out / "plain.csv", index=False)
frame.to_csv(out / "index.csv")
frame.to_csv(out / "packed.csv.gz", index=False)
frame.to_parquet(out / "frame.parquet", index=False)
frame.to_feather(out / "frame.feather")
frame.to_json(out / "frame.json")
frame.to_pickle(out / "frame.pkl")
frame.assign(record=np.repeat([1, 2], n // 2)).to_csv(out / "records.csv", index=False)
frame.assign(time=pd.Timestamp("2026-05-01 12:00") + pd.to_timedelta(t, "s")).to_csv(out / "pandas_dates.csv", index=False)
text("german_excel.csv", "\ufefftime [s];u [N];y [m]\n" + rows(";", ","), "utf-8")
text("latin1.csv", "time [s];u [N];Winkel [°]\n" + rows(";", ","), "latin-1")
text("utf16.csv", "time [s]\tu [N]\ty [m]\n" + rows("\t"), "utf-16")
text("utf16_no_mark.csv", "time [s],u [N],y [m]\n" + rows(), "utf-16-be")
text("sep_line.csv", "sep=;\ntime;u;y\n" + rows(";"))
text("round_brackets.csv", "Time (s),Torque (N mm),Angle (deg)\n" + rows())
text("slashes.csv", "t/s;torque/N m;angle/deg\n" + rows(";", ","))
text("unit_row.csv", "time,u,y\ns,N,m\n" + rows())
text("logger.csv", "DataLogger 3000\nSerial no.: 12345\nSample rate,50,Hz,,\n\nTime,Channel 1,Channel 2\ns,V,mm\n" + rows())
text("iso_times.csv", "time,u,y\n" + "".join(
    f"2026-05-01T12:{int(t[k]) // 60:02d}:{t[k] % 60:06.3f}Z,{u[k]:.6f},{y[k]:.6f}\n" for k in range(n)))
text("european_dates.csv", "time,u,y\n" + "".join(f"01/05/2026 12:00:{t[k]:06.3f},{u[k]:.6f},{y[k]:.6f}\n" for k in range(n)))
text("missing_rows.csv", "time,u,y\n" + rows(keep=[k for k in range(n) if k not in (7, 20, 21, 22)]))
text("jitter.csv", "time,u,y\n" + rows(times=t + 0.001 * np.sin(7.0 * np.arange(n))))
text("unsorted.csv", "time,u,y\n" + rows(keep=[0, 1, 3, 2, *range(4, n)]))
text("thousands.csv", "time;u;y\n0;1.234,5;2\n1;1.234,5;2\n")
text("other_names.csv", "t,u,y\n" + rows())
with wave.open(str(out / "sound.wav"), "wb") as f:
    f.setnchannels(1), f.setsampwidth(2), f.setframerate(50), f.writeframes((1000 * y).astype("<i2").tobytes())
text("model.toml", "sampling_time = 0.02\n[model.duffing]\nmass = 1.0\n")
(out / "random.bin").write_bytes(np.random.default_rng(1).bytes(400))
(out / "empty.csv").write_bytes(b"")
import zipfile
with zipfile.ZipFile(out / "book.xlsx", "w") as f:
    f.writestr("xl/workbook.xml", "<workbook/>")
with zipfile.ZipFile(out / "zipped.zip", "w") as f:
    f.write(out / "plain.csv", "plain.csv")
pickle.dump({"u": u}, open(out / "record.pickle", "wb"))

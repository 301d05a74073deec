//! What kind of file it is, told by its first bytes, and who reads it.

use super::csv;
use super::error::DataError;
use super::table::Table;
use super::{mat, npy, npz, records};

/// First bytes of kinds that hold records but are not read, what they are, and how to make
/// a file of them that is.
const OTHERS: &[(&[u8], &str, &str)] = &[
    (
        b"\x89HDF\r\n\x1a\n",
        "an HDF5 file",
        "in Python: `f = h5py.File('record.h5'); np.savez('record.npz', **{k: f[k][()] for k in f})`; in MATLAB: `S = load('record.mat'); save('record7.mat', '-struct', 'S', '-v7')`",
    ),
    (
        b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1",
        "a workbook of an old Excel",
        "in Excel, save the sheet as `CSV UTF-8`",
    ),
    (
        b"PAR1",
        "a Parquet file, which this program was built without",
        "build it with `--features parquet`, or in Python: `pandas.read_parquet('record.parquet').to_csv('record.csv', index=False)`",
    ),
    (
        b"ARROW1",
        "an Arrow (Feather) file",
        "in Python: `pandas.read_feather('record.feather').to_csv('record.csv', index=False)`",
    ),
    (
        b"TDSm",
        "a TDMS file of LabVIEW",
        "in Python: `nptdms.TdmsFile('record.tdms').as_dataframe().to_csv('record.csv', index=False)`",
    ),
    (
        b"MDF     ",
        "an MDF measurement file",
        "in Python: `asammdf.MDF('record.mf4').export('csv', 'record.csv', single_time_base=True)`",
    ),
    (
        b"SQLite format 3\0",
        "an SQLite database",
        "in its shell: `.mode csv`, `.headers on`, `.output record.csv`, `SELECT * FROM ..;`",
    ),
    (
        b"RIFF",
        "a WAVE or another RIFF file",
        "in Python: `rate, y = scipy.io.wavfile.read('record.wav'); np.savez('record.npz', y=y, Ts=1/rate)`",
    ),
    (b"BZh", "packed by bzip2", "unpack it: `bunzip2`; of packed files, .gz is read"),
    (b"\xFD7zXZ\0", "packed by xz", "unpack it: `unxz`; of packed files, .gz is read"),
    (b"\x28\xB5\x2F\xFD", "packed by zstd", "unpack it: `unzstd`; of packed files, .gz is read"),
    (
        b"\x80\x02",
        "a Python pickle",
        "save arrays instead: `np.savez('record.npz', u=u, y=y, Ts=Ts)`",
    ),
    (
        b"\x80\x04",
        "a Python pickle",
        "save arrays instead: `np.savez('record.npz', u=u, y=y, Ts=Ts)`",
    ),
    (
        b"\x80\x05",
        "a Python pickle",
        "save arrays instead: `np.savez('record.npz', u=u, y=y, Ts=Ts)`",
    ),
];

/// The records of a file.
pub(super) fn tables(bytes: &[u8], source: &str) -> Result<Vec<Table>, DataError> {
    if bytes.starts_with(npy::MAGIC) {
        return npy::tables(bytes, source);
    }
    if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06") {
        return npz::tables(bytes, source);
    }
    if mat::is_one(bytes) {
        return mat::tables(bytes, source);
    }
    #[cfg(feature = "parquet")]
    if bytes.starts_with(b"PAR1") {
        return super::parquet::tables(bytes, source);
    }
    let other = OTHERS.iter().find(|(first, ..)| bytes.starts_with(first));
    if let Some((_, found, remedy)) = other {
        return Err(DataError::of_other_kind(source, found, remedy));
    }
    let text = bytes.trim_ascii_start();
    if text.starts_with(b"{") {
        return Err(DataError::of_other_kind(
            source,
            "JSON text",
            "in Python: `pandas.read_json('record.json').to_csv('record.csv', index=False)`",
        ));
    }
    let model = |line: &[u8]| line.starts_with(b"[model.") || line.starts_with(b"[[effects]]");
    if bytes.split(|byte| *byte == b'\n').take(200).any(model) {
        return Err(DataError::of_other_kind(source, "a model file", "hand it in by --model"));
    }
    records::of_column(csv::parse(bytes, source)?)
}

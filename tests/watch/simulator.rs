//! A simulation that writes its frames the way real ones do, faster.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::thread::sleep;
use std::time::Duration;

/// How frames are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// A hidden file takes the name when it is whole.
    Polite,
    /// The name is opened and written in pieces.
    Rude,
    /// Rude, frames out of order.
    Shuffled,
    /// Rude, but the file has its size, in zeros, from the start.
    Preallocated,
    /// Rude, and one frame stops half way for longer than anybody's patience.
    Stalling,
    /// Rude, and every name has the frame before as contents when it begins.
    InPlace,
    /// Rude, and the file is closed and opened again after every piece.
    Reopening,
    /// Two rude writers at a time.
    Parallel,
    /// All of these; one frame is written again later, one never, one stays cut.
    Mixed,
}

pub const MANNERS: [Manner; 9] = [
    Manner::Polite,
    Manner::Rude,
    Manner::Shuffled,
    Manner::Preallocated,
    Manner::Stalling,
    Manner::InPlace,
    Manner::Reopening,
    Manner::Parallel,
    Manner::Mixed,
];

/// The frame that stalls, in the middle.
const STALLING: usize = 3;
/// What becomes of frames of [`Manner::Mixed`].
pub const DROPPED: usize = 4;
pub const CUT: usize = 6;
pub const REWRITTEN: usize = 1;

/// Frames to be written to a folder.
pub struct Simulation {
    pub folder: PathBuf,
    /// The contents by number, from 0.
    pub frames: Vec<Vec<u8>>,
    pub manner: Manner,
    /// Between two pieces of a file.
    pub pause: Duration,
    /// How long the stalling frame stalls.
    pub stall: Duration,
}

/// Where and how a frame is written.
struct Stroke<'a> {
    path: &'a Path,
    contents: &'a [u8],
    manner: Manner,
    stall: Duration,
    /// Bytes that are written in the end.
    upto: usize,
}

impl Simulation {
    /// Writes all frames, and `DONE` at the end. Returns what is there then, cut files left out.
    pub fn run(&self) -> BTreeMap<usize, Vec<u8>> {
        fs::create_dir_all(&self.folder).unwrap();
        let mut truth: BTreeMap<usize, Vec<u8>> = self.frames.iter().cloned().enumerate().collect();
        if self.manner == Manner::InPlace {
            for number in 0..self.frames.len() {
                fs::write(self.path(number), &self.frames[number.saturating_sub(1)]).unwrap();
            }
            sleep(self.pause * 10);
        }
        match self.manner {
            Manner::Parallel => self.in_parallel(),
            Manner::Shuffled | Manner::Mixed => self.order().for_each(|number| self.write(number)),
            _ => (0..self.frames.len()).for_each(|number| self.write(number)),
        }
        if self.manner == Manner::Mixed {
            let other = &self.frames[REWRITTEN + 1];
            self.draw(&Stroke {
                contents: other,
                upto: other.len(),
                ..self.stroke(&self.path(REWRITTEN), other)
            });
            truth.insert(REWRITTEN, other.clone());
            truth.remove(&DROPPED);
            truth.remove(&CUT);
        }
        fs::write(self.folder.join("DONE"), "").unwrap();
        truth
    }

    pub fn path(&self, number: usize) -> PathBuf {
        self.folder.join(format!("frame_{number:04}.ply"))
    }

    /// The second frame of every two first.
    fn order(&self) -> impl Iterator<Item = usize> {
        let count = self.frames.len();
        (0..count).map(move |i| if (i ^ 1) < count { i ^ 1 } else { i })
    }

    fn in_parallel(&self) {
        let next = Mutex::new(0..self.frames.len());
        std::thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| {
                    loop {
                        let number = next.lock().unwrap().next();
                        let Some(number) = number else { break };
                        self.write(number);
                    }
                });
            }
        });
    }

    fn write(&self, number: usize) {
        let path = self.path(number);
        let contents = &self.frames[number];
        let stroke = self.stroke(&path, contents);
        let mixed = self.manner == Manner::Mixed;
        let stroke = match number {
            DROPPED if mixed => return,
            CUT if mixed => Stroke { upto: contents.len() * 3 / 5, ..stroke },
            STALLING if mixed || self.manner == Manner::Stalling => {
                Stroke { stall: self.stall, manner: Manner::Stalling, ..stroke }
            }
            0 if mixed => Stroke { manner: Manner::Polite, ..stroke },
            2 if mixed => Stroke { manner: Manner::Preallocated, ..stroke },
            _ => stroke,
        };
        self.draw(&stroke);
    }

    fn stroke<'a>(&self, path: &'a Path, contents: &'a [u8]) -> Stroke<'a> {
        Stroke { path, contents, manner: self.manner, stall: Duration::ZERO, upto: contents.len() }
    }

    fn draw(&self, stroke: &Stroke<'_>) {
        let hidden = stroke.path.with_file_name(format!(".{}.tmp", std::process::id()));
        let polite = stroke.manner == Manner::Polite;
        let path = if polite { hidden.as_path() } else { stroke.path };
        let mut file = File::create(path).unwrap();
        if stroke.manner == Manner::Preallocated {
            file.set_len(stroke.contents.len() as u64).unwrap();
        }
        let cuts = cuts(stroke.upto);
        for (k, piece) in cuts.windows(2).enumerate() {
            if stroke.manner == Manner::Reopening {
                drop(file);
                file = OpenOptions::new().write(true).open(path).unwrap();
            }
            file.seek(SeekFrom::Start(piece[0] as u64)).unwrap();
            file.write_all(&stroke.contents[piece[0]..piece[1]]).unwrap();
            if k == cuts.len() / 2 {
                sleep(stroke.stall);
            }
            sleep(self.pause);
        }
        drop(file);
        if polite {
            fs::rename(path, stroke.path).unwrap();
        }
    }
}

/// Uneven pieces: half a header first, the last without a whole record.
fn cuts(length: usize) -> Vec<usize> {
    let mut cuts = vec![0, 7, length / 4, length / 2, length - length / 8, length - 3, length];
    cuts.sort_unstable();
    cuts
}

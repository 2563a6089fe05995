use glam::Vec3;
use proptest::prelude::*;
use sha2::{Digest, Sha256};

use super::*;
use crate::film::{FilmSample, PixelAccumulator};

const RANGE: SamplesRange = SamplesRange { first: 2, end: 5 };

const TOOK: Took = Took { seconds: 2.5, thread_seconds: 10.0, cpu_seconds: 9.0 };

#[test]
fn what_parts_took_is_what_all_of_them_took() {
    let mut took = TOOK;
    took += Took { seconds: 7.5, thread_seconds: 7.5, cpu_seconds: 7.0 };
    assert_eq!(took, Took { seconds: 10.0, thread_seconds: 17.5, cpu_seconds: 16.0 });
    assert_eq!((TOOK.threads(), took.threads(), Took::default().threads()), (4, 2, 1));
    // What was done before a checkpoint counts.
    let [whole, rest] = [3.0, 1.0].map(|rendered| Took::of(3.0, rendered, 8).cpu_seconds);
    assert!(rest - whole >= 16.0, "{whole} {rest}");
}

/// Of 20 x 3 pixels, in two tiles.
fn wanted() -> Wanted {
    Wanted { number: FrameNumber::ONE, resolution: [20, 3], samples: 8, fingerprint: Fingerprint([3; 16]) }
}

fn sums() -> Accumulation {
    let mut sums = Accumulation::of_range(wanted().resolution, RANGE.first);
    for part in &mut sums.parts {
        for pixel in &mut part.sums {
            for (index, value) in [(2, 1.0), (3, 1e-30), (4, f32::INFINITY)] {
                pixel.add(index, &FilmSample::of_sky(Vec3::splat(value)));
            }
        }
        part.passes = RANGE.end;
        part.counters.rays = u64::MAX;
    }
    sums
}

/// The bytes of a file.
fn written(label: &Label) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = RANGE.partial_of(&folder.path().join("a.exr"));
    write(&path, label, &sums(), BeamRecord { beams: 7, ..BeamRecord::default() }, TOOK).unwrap();
    assert_eq!(read_label(&path).as_ref(), Ok(label));
    assert!(read(&path, label).is_ok());
    assert!(
        read(&path, &wanted().label(SamplesRange { first: 0, end: 5 })).unwrap_err().contains("replaced")
    );
    std::fs::read(&path).unwrap()
}

fn sealed(body: &[&[u8]]) -> Vec<u8> {
    let mut bytes = body.concat();
    bytes.extend(Sha256::digest(&bytes));
    bytes
}

#[test]
fn what_was_written_comes_back_and_adds_up() {
    let (label, contents) = decoded(&written(&wanted().label(RANGE))).unwrap();
    assert_eq!(wanted().check(&label), Ok(()));
    assert_eq!(contents.parts, sums().parts);
    assert_eq!((contents.beams.beams, contents.took), (7, TOOK));
    let mut merged = Accumulation::of_range(wanted().resolution, 0);
    assert!(merged.add(&contents.parts, contents.counters, label.range));
    let pixels = merged.finish().0.pixels;
    assert!(pixels.iter().all(|pixel| (pixel.samples, pixel.rejected) == (2, 1)));
}

#[test]
fn other_sums_than_those_of_the_label_are_refused() {
    let refused = |change: &dyn Fn(&mut TilePart), range| {
        let mut other = sums();
        change(&mut other.parts[1]);
        !Accumulation::of_range(wanted().resolution, 0).add(&other.parts, other.counters, range)
    };
    assert!(!refused(&|_| (), RANGE));
    assert!(refused(&|_| (), SamplesRange { first: 1, end: 5 }));
    assert!(refused(&|_| (), SamplesRange { first: 2, end: 6 }));
    assert!(refused(&|part| part.ahead = 1, RANGE));
    assert!(refused(&|part| drop(part.sums.pop()), RANGE));
    assert!(refused(&|part| part.sums[4] = PixelAccumulator::new(), RANGE));
    assert!(refused(&|part| *part = TilePart::default(), RANGE));
    let mut fewer = Accumulation::of_range(wanted().resolution, 0);
    assert!(!fewer.add(&sums().parts[..1], Counters::default(), RANGE));
}

#[test]
fn what_is_of_something_else_is_named_with_a_cure() {
    let usual = wanted().label(RANGE);
    for (label, words) in [
        (
            Label { version: "0.0.1".into(), ..usual.clone() },
            ["floe 0.0.1", "render it again with --samples-range 2..5"],
        ),
        (Label { pixels: 1, ..usual.clone() }, ["other pixels", "render it again"]),
        (Label { frame: 5, ..usual.clone() }, ["another frame than 1", "give it back its name"]),
        (Label { samples: 16, ..usual.clone() }, ["a part of 16 samples, not of 8", "--samples 16"]),
        (Label { resolution: [3, 20], ..usual.clone() }, ["3 x 20 pixels", "20 x 3"]),
        (Label { fingerprint: [4; 16], ..usual.clone() }, ["another scene", "--seed"]),
        (Label { range: SamplesRange { first: 4, end: 9 }, ..usual.clone() }, ["damaged", "remove it"]),
        (Label { range: SamplesRange { first: 4, end: 4 }, ..usual }, ["damaged", "remove it"]),
    ] {
        let problem = wanted().check(&label).unwrap_err();
        assert!(words.iter().all(|word| problem.contains(word)), "{problem}");
    }
}

#[test]
fn damage_is_noticed_at_every_byte() {
    let whole = written(&wanted().label(RANGE));
    for at in 0..whole.len() {
        let mut damaged = whole.clone();
        damaged[at] ^= 1;
        assert!(decoded(&damaged).is_err() && decoded(&whole[..at]).is_err(), "{at}");
    }
    let other = [KIND.as_bytes(), b"0 []\n"].concat();
    assert!(decoded(&other).unwrap_err().contains("another version"));
    assert!(decoded(b"PNG").unwrap_err().contains("damaged"));
}

proptest! {
    /// With a seal that is right the rest may still be anything.
    #[test]
    fn contents_of_any_kind_do_no_harm(
        noise in prop::collection::vec(any::<u8>(), 0..200),
        at in 0..2000_usize,
    ) {
        let label = wanted().label(RANGE);
        let mut changed = written_once().clone();
        changed.truncate(changed.len() - 32);
        let start = head().len() + at % (changed.len() - head().len());
        for (byte, noise) in changed[start..].iter_mut().zip(&noise) {
            *byte = *noise;
        }
        let alone = sealed(&[head().as_bytes(), &postcard::to_allocvec(&label).unwrap(), &noise]);
        for bytes in [sealed(&[&changed]), alone] {
            if let Ok((label, contents)) = decoded(&bytes) {
                let _ = wanted().check(&label);
                let mut merged = Accumulation::of_range(wanted().resolution, 0);
                if merged.add(&contents.parts, contents.counters, RANGE) {
                    merged.finish();
                }
            }
        }
    }
}

fn written_once() -> &'static Vec<u8> {
    static WRITTEN: std::sync::OnceLock<Vec<u8>> = std::sync::OnceLock::new();
    WRITTEN.get_or_init(|| written(&wanted().label(RANGE)))
}

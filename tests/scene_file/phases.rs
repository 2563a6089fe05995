//! `phase`: functions over wavelength.

use floe::optics::phase::{Deflection, MediumPhase};
use floe::spectrum::Wavelengths;

use crate::{Wrong, assert_wrong, example};

/// Normalised values straight on, of lobes (1 + g) / (4 pi (1 - g)^2) and of tables that are linear in the cosine
/// a / (pi (a + 2 b + c)).
#[test]
fn phase_functions_over_wavelength_are_read() {
    let scene = example("phase functions");
    let at = |name: &str, lambda: f32| {
        let MediumPhase::Spectral(phase) = &scene.media[name].phase else { panic!("{name} is not spectral") };
        let lanes = phase.at(&Wavelengths::single(lambda));
        f64::from(lanes.value(Deflection::FORWARD).x) * std::f64::consts::PI
    };
    let tables = [9.0 / 13.0, 2.0 / 6.0];
    for (name, lambda, expected) in [
        ("plankton", 550.0, 1.94 / (4.0 * 0.06 * 0.06)),
        ("plankton", 390.0, 1.96 / (4.0 * 0.04 * 0.04)),
        ("colloid", 400.0, tables[0]),
        ("colloid", 600.0, 0.25 * tables[0] + 0.75 * tables[1]),
    ] {
        // Rounding of g changes the square of its difference to 1 by 3e-6.
        assert!((at(name, lambda) / expected - 1.0).abs() < 1e-5, "{name} {lambda}: {}", at(name, lambda));
    }
}

/// What is wrong with phase functions over wavelength.
#[rustfmt::skip]
const WRONG: &[Wrong] = &[
    ("[media.a]\nphase = { kind = 'henyey-greenstein', g = { wavelength = [500], value = [1] } }", 2, 74,
     "media.a.phase.g.value[0]: 1: write a number between -1 and 1"),
    ("[media.a]\nphase = { kind = 'henyey-greenstein', g = { wavelength = [500, 600], value = [0.5] } }", 2, 78, "1 numbers for 2 wavelengths"),
    ("[media.a]\nphase = { kind = 'henyey-greenstein', g = { value = [0.5] } }", 2, 43, "[media.a.phase.g] has no `wavelength`"),
    ("[media.a]\nphase = { kind = 'henyey-greenstein', g = [0.5, 0.6, 0.7] }", 2, 43, "media.a.phase.g: [0.5, 0.6, 0.7]: write"),
    ("[media.a]\nphase = { kind = 'schlick', k = { wavelength = [500], value = [0.5] } }", 2, 33, "write a number between"),
    ("[media.a]\nphase = { kind = 'tabulated', wavelength = [500, 400], angle = [0], value = [[1], [1]] }", 2, 50, "wavelengths must rise strictly"),
    ("[media.a]\nphase = { kind = 'tabulated', wavelength = [400, 500], angle = [0], value = [[1]] }", 2, 77, "1 lists for 2 wavelengths: write one for each"),
    ("[media.a]\nphase = { kind = 'tabulated', wavelength = [400], angle = [0, 9], value = [[1]] }", 2, 76,
     "media.a.phase.value[0]: [1]: 1 numbers for 2 angles: write one for each"),
    ("[media.a]\nphase = { kind = 'tabulated', wavelength = [400], angle = [0, 9], value = [1, 2] }", 2, 75, "2 lists for 1 wavelengths"),
    ("[media.a]\nphase = { kind = 'tabulated', wavelength = [400], angle = [0], value = [1] }", 2, 73, "write one number for each angle"),
    ("[media.a]\nphase = { kind = 'tabulated', wavelength = [400], angle = [0], value = [[-1]] }", 2, 74, "media.a.phase.value[0][0]: -1: write a number that is not below 0"),
    ("[media.a]\nphase = { kind = 'tabulated', wavelength = [400, 500], angle = [0], value = [[1], [0]] }", 2, 83,
     "media.a.phase.value[1]: [0]: nothing is scattered at this wavelength: write a number above 0"),
    ("[media.a]\nphase = { kind = 'tabulated', wavelength = [400], value = [[1]] }", 2, 9, "[media.a.phase] has no `angle`"),
    ("[media.a]\nphase = { kind = 'isotropic', wavelength = [400] }", 2, 31, "unknown key `wavelength` in [media.a.phase]"),
];

#[test]
fn every_wrong_phase_function_is_named_with_its_place() {
    assert_wrong(WRONG);
}

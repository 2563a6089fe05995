//! `model = ..` of media: what is in them, and what cannot be.

use floe::optics::RefractiveIndex;
use floe::optics::particles::SizeDistribution;
use floe::optics::phase::{HenyeyGreenstein, PhaseFunction};
use floe::optics::water::natural::NaturalWater;
use floe::scene::description::{DensityDescription, Model, ModelKind, ModelPhase};
use floe::spectrum::Spectrum;

use crate::{Wrong, assert_wrong, example, parse};

fn model(name: &str) -> Model {
    example("models").media[name].model.clone().unwrap_or_else(|| panic!("{name} has no model"))
}

fn fractions(model: &Model) -> Vec<(&str, f64)> {
    model.mixture.species.iter().map(|s| (s.name.as_str(), s.volume_fraction)).collect()
}

#[test]
fn waters_are_presets_with_what_is_said_otherwise() {
    let baltic = model("baltic");
    assert_eq!((baltic.kind, &baltic.phase), (ModelKind::NaturalWater, &ModelPhase::LorenzMie));
    assert_eq!(fractions(&baltic), [("minerals", 5.429e-7), ("algae", 1.904e-6)]);
    let index = RefractiveIndex::Water { temperature: 10.0, salinity: 8.0 };
    assert_eq!(baltic.mixture.host.index, index);
    assert_eq!(example("models").media["baltic"].ior, index);
    assert_eq!((&baltic.mixture.host.molecular, baltic.warnings.len()), (&None, 0));
    let lake = model("lake");
    assert_eq!(fractions(&lake), [("minerals", 1e-7), ("algae", 2e-7), ("rock flour", 1e-6)]);
    assert!(lake.mixture.host.molecular.is_some());
    let density = &example("models").media["lake"].density;
    assert_eq!(*density, DensityDescription::Stratified { depth: 2.0, surface: 0.0 });
    let plain = parse("[media.a]\nmodel = 'natural-water'").unwrap().media["a"].model.clone().unwrap();
    assert_eq!(plain.mixture, NaturalWater::SEA.mixture());
}

/// 1 - 0.894 / (0.917 + 5 x 1.403e-4).
#[test]
fn ice_has_the_air_that_its_density_says() {
    let ice = model("ice");
    assert_eq!((ice.kind, fractions(&ice).len()), (ModelKind::Iceberg, 1));
    let (name, air) = fractions(&ice)[0];
    assert!(name == "air" && (air - 0.025_827_0).abs() < 1e-7, "{name} {air}");
    let waterline = model("waterline");
    assert_eq!(waterline.phase, ModelPhase::HenyeyGreenstein);
    let lobe = PhaseFunction::HenyeyGreenstein(HenyeyGreenstein { g: 0.9 });
    assert_eq!(model("cream").phase, ModelPhase::Given(lobe.into()));
    assert_eq!(fractions(&waterline)[1], ("algae", 2e-6));
}

/// 1.5 / 0.915 / (100 / 1.03) and 0.76 x 3.3 / 1.11 / (100 / 1.03).
#[test]
fn milk_has_the_fat_and_the_casein_that_its_mass_says() {
    let milk = model("milk");
    let [(fat, v_fat), (casein, v_casein)] = fractions(&milk)[..] else { panic!() };
    assert_eq!((fat, casein), ("fat", "casein"));
    assert!(
        (v_fat - 0.016_885_2).abs() < 1e-7 && (v_casein - 0.023_272_4).abs() < 1e-7,
        "{v_fat} {v_casein}"
    );
    assert!(fractions(&model("cream"))[0].1 > 0.33);
}

#[test]
fn particles_are_as_they_are_given() {
    let paint = model("paint");
    assert_eq!(paint.kind, ModelKind::Particles);
    assert_eq!(paint.mixture.host.absorption, Spectrum::Rgb([0.4, 0.1, 0.1]));
    assert_eq!(fractions(&paint), [("titania", 1e-3), ("chalk", 0.01), ("species 2", 1e-4)]);
    let sizes: Vec<&SizeDistribution> = paint.mixture.species.iter().map(|s| &s.sizes).collect();
    let SizeDistribution::LogNormal { median, deviation } = sizes[0] else { panic!() };
    assert!((median - 0.1e-6).abs() < 1e-18 && *deviation == 0.2);
    let SizeDistribution::PowerLaw { exponent, least, greatest } = sizes[1] else { panic!() };
    assert!((least - 0.1e-6).abs() < 1e-18 && (greatest - 5e-6).abs() < 1e-18 && *exponent == 4.0);
    let SizeDistribution::Table { radii, number } = sizes[2] else { panic!() };
    assert!((radii[2] - 50e-6).abs() < 1e-18 && number == &[0.0, 3.0, 1.0]);
}

#[test]
fn formulas_out_of_their_range_are_told() {
    let warnings = |text: &str| parse(text).unwrap().media["a"].model.clone().unwrap().warnings;
    let cold = "[media.a]\nmodel = 'iceberg'\ntemperature = -45";
    assert_eq!(
        warnings(cold),
        ["temperature = -45: what ice encloses is known from -30 to 0 degrees Celsius; -30 is taken"]
    );
    let taken = parse(&cold.replace("-45", "-30")).unwrap().media["a"].model.clone().unwrap();
    assert_eq!(parse(cold).unwrap().media["a"].model.clone().unwrap().mixture, taken.mixture);
    let hot = "temperature = 35: the index of water is known from 0 to 30 degrees Celsius; beyond it is extrapolated";
    let chalk = "species = [{ ior = 1.5, volume_fraction = 0.1, sizes = { kind = 'table', radius_um = [1], number = [1] } }]";
    for text in [
        "model = 'natural-water'\ntemperature = 35",
        "ior = { table = 'water', temperature = 35 }",
        &format!("model = 'particles'\nior = {{ table = 'water', temperature = 35 }}\n{chalk}"),
    ] {
        assert_eq!(parse(&format!("[media.a]\n{text}")).unwrap().media["a"].warnings(), [hot], "{text}");
    }
}

/// What is wrong with models.
#[rustfmt::skip]
const WRONG: &[Wrong] = &[
    ("[media.a]\nmodel = 'ice'", 2, 9, "media.a.model: 'ice': "),
    ("[media.a]\nmodel = 3", 2, 9, "write one of `natural-water`, `iceberg`, `milk` and `particles` in quotes"),
    ("[media.a]\nmodel = 'natural-water'\npreset = 'north_sea'", 3, 10, "did you mean `north-sea`?"),
    ("[media.a]\nmodel = 'natural-water'\npreset = 'skimmed'", 3, 10, "write one of `atlantic`, `baltic`, `channel`, `mediterranean`, `north-sea` and `pukaki`"),
    ("[media.a]\nmodel = 'natural-water'\nabsorption = 1", 3, 14, "media.a.absorption: 1: \"natural-water\" computes this from what is in it: remove this, or `model`"),
    ("[media.a]\nmodel = 'iceberg'\nior = 1.31", 3, 7, "media.a.ior: 1.31: \"iceberg\" computes this"),
    ("[media.a]\nmodel = 'milk'\nscattering = [1, 1, 1]", 3, 14, "\"milk\" computes this"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = []\nalbedo = 1", 5, 10, "\"particles\" computes this"),
    ("[media.a]\nmodel = 'milk'\nphase = { kind = 'rayleig' }", 3, 18, "did you mean `rayleigh`?"),
    ("[media.a]\nmodel = 'milk'\nphase = 0.9", 3, 9, "write one of `lorenz-mie` and `henyey-greenstein` in quotes"),
    ("[media.a]\nmodel = 'milk'\nphase = 'rayleigh'", 3, 9, "write one of `lorenz-mie` and `henyey-greenstein`"),
    ("[media.a]\nmodel = 'milk'\nalgae = 1e-6", 3, 1, "unknown key `algae` in [media.a]"),
    ("[media.a]\npreset = 'baltic'", 2, 1, "unknown key `preset` in [media.a]"),
    ("[media.a]\nmodel = 'natural-water'\nalgae = -1e-6", 3, 9, "media.a.algae: -1e-6: write a share of the volume from 0 to 1"),
    ("[media.a]\nmodel = 'natural-water'\nmineral = nan", 3, 11, "write a share of the volume from 0 to 1"),
    ("[media.a]\nmodel = 'natural-water'\nmineral = 0.6\nalgae = 0.6", 2, 9, "the volume fractions of minerals, algae are 1.2 altogether"),
    ("[media.a]\nmodel = 'natural-water'\nsalinity = 36", 3, 12, "media.a.salinity: 36: write a salinity from 0 to 35 parts per thousand"),
    ("[media.a]\nior = { table = 'water', salinity = 40 }", 2, 37, "write a salinity from 0 to 35 parts per thousand"),
    ("[media.a]\nmodel = 'iceberg'\nsalinity = 101", 3, 12, "write a salinity from 0 to 100 parts per thousand"),
    ("[media.a]\nmodel = 'natural-water'\ntemperature = 400", 3, 15, "write a temperature from -10 to 100"),
    ("[media.a]\nmodel = 'natural-water'\ncdom = -1", 3, 8, "write an absorption at 440 nm from 0 to 1e6 1/m"),
    ("[media.a]\nmodel = 'natural-water'\nmolecular_scattering = 1", 3, 24, "write true or false"),
    ("[media.a]\nmodel = 'iceberg'\nice_density = 0.894", 3, 15, "write a density from 1 to 1000 kg/m^3"),
    ("[media.a]\nmodel = 'iceberg'\nice_density = 930", 3, 15, "it has none at 919.105 kg/m^3; write at most that"),
    ("[media.a]\nmodel = 'iceberg'\ntemperature = -0.1\nsalinity = 5", 4, 12, "nothing of it is frozen; write a lower temperature or salinity"),
    ("[media.a]\nmodel = 'iceberg'\ntemperature = 300", 3, 15, "write a temperature from -273.15 to 100"),
    ("[media.a]\nmodel = 'milk'\nfat = 99", 3, 7, "media.a.fat: 99: write fat from 0 to 50 % of the mass"),
    ("[media.a]\nmodel = 'milk'\nhomogenisation_pressure = 200", 3, 27, "write a pressure from 0 to 50 MPa"),
    ("[media.a]\nmodel = 'milk'\nprotein = inf", 3, 11, "write protein from 0 to 20 % of the mass"),
    ("[media.a]\nmodel = 'particles'", 1, 1, "[media.a] has no `ior`: write the index of what the particles lie in"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3", 1, 1, "[media.a] has no `species`: write a list"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = []", 4, 11, "media.a.species: []: write a list"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [7]", 4, 12, "media.a.species[0]: 7: write a table such as"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ volume_fraction = 1 }]", 4, 12, "media.a.species[0] has no `ior`"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = 1.5 }]", 4, 12, "has no `volume_fraction`: write the share"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = 1.5, volume_fraction = 1 }]", 4, 12, "has no `sizes`: write { kind = \"power-law\""),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = 1.5, volume_fraction = 1, sizes = { kind = 'gamma' } }]", 4, 63, "write one of `power-law`, `log-normal` and `table`"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = 1.5, volume_fraction = 1, sizes = { kind = 'log-normal', median_um = 1 } }]", 4, 54, "has no `deviation`"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = 1.5, volume_fraction = 1, sizes = { kind = 'log-normal', median = 1 } }]", 4, 77, "unknown key `median`"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = 1.5, volume_fraction = 1, sizes = { kind = 'power-law', least_um = 5, greatest_um = 1 } }]", 4, 104, "the greatest radius must be above the least"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = 1.5, volume_fraction = 1, sizes = { kind = 'power-law', least_um = 0 } }]", 4, 87, "write a radius from 0.0001 to 3000 micrometres"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = 1.5, volume_fraction = 1, sizes = { kind = 'table', radius_um = [2, 1] } }]", 4, 88, "radii must rise strictly"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = 1.5, volume_fraction = 1, sizes = { kind = 'table', radius_um = [1, 2], number = [1] } }]", 4, 101, "1 numbers for 2 radii"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = 1.5, volume_fraction = 1, sizes = { kind = 'table', radius_um = [1, 2], number = [0, 0] } }]", 4, 101, "there are no particles of any size"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nspecies = [{ ior = { wavelength = [500, 400], n = [1.5, 1.5] }, volume_fraction = 1 }]", 4, 41, "wavelengths must rise strictly"),
    ("[media.a]\nmodel = 'particles'\nior = 1.3\nemission = 1\nspecies = [{ ior = 1.5, volume_fraction = 1e-3, sizes = { kind = 'log-normal', median_um = 1, deviation = 0.3 } }]", 4, 12, "this one absorbs nothing"),
];

#[test]
fn what_is_wrong_with_models_is_named() {
    assert_wrong(WRONG);
}

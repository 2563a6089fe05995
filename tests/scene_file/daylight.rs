//! `[sun]` and `[sky]`: where the sun stands, what it has, and the sky that goes with it.

use floe::light::ClearAir;
use floe::scene::description::{Axis, Daylight, SkyDescription};
use floe::spectrum::Spectrum;

use crate::{Wrong, assert_wrong, example, parse};

#[test]
fn the_sun_is_where_its_place_says_and_the_sky_goes_with_it() {
    let scene = example("clear sky");
    assert_eq!(scene.sky, SkyDescription::Clear(ClearAir { turbidity: 2.5, ground_albedo: 0.3 }));
    let sun = &scene.suns[0];
    let [elevation, azimuth] = sun.angles(Axis::Z);
    // Unit vectors in single precision: 6e-8 of a radian and its double.
    assert!((elevation - 35.5).abs() < 1e-5 && (azimuth - 240.0).abs() < 1e-5, "{elevation} {azimuth}");
    // 120 degrees to the left of +x.
    assert!((sun.direction.y / sun.direction.x - (120.0_f32).to_radians().tan()).abs() < 1e-5);
    assert_eq!((sun.angular_diameter, scene.output.exposure), (0.5, -6.0));
    assert!(sun.irradiance.is_spectral());

    let scene = example("summer afternoon");
    assert_eq!(scene.sky, SkyDescription::Clear(ClearAir { turbidity: 3.0, ground_albedo: 0.1 }));
    let sun = &scene.suns[0];
    let [elevation, azimuth] = sun.angles(Axis::Z);
    // Copenhagen at 12:30 UTC; pysolar 0.13 has 54.65 and 212.21 degrees.
    assert!((elevation - 54.65).abs() < 0.05 && (azimuth - 212.21).abs() < 0.05, "{elevation} {azimuth}");
    // A white card in the sun is shown as white: 1 is 683 pi lx.
    let daylight = Daylight::new(&scene.suns, &scene.sky, Axis::Z);
    assert_eq!(scene.output.exposure, daylight.exposure());
    let card = daylight.sun + daylight.sky_level.unwrap();
    assert!(
        (90e3..120e3).contains(&card)
            && (f64::from(scene.output.exposure) + (card / 2145.7).log2()).abs() < 0.051
    );

    let scene = example("measured sun");
    let Spectrum::Table { wavelengths, values } = &scene.suns[0].irradiance else { panic!("no table") };
    assert_eq!((wavelengths[34], values[34], scene.output.exposure), (550.0, 0.5 * 1.3657, 0.0));
}

/// The sky and its sun's light are those of the first; what others have they say, and they may stand below the horizon.
#[test]
fn suns_are_read_in_order_and_the_first_lights_the_sky() {
    let alone = "[sun]\nelevation = 4\nazimuth = 280\n[sky]\nradiance = { model = \"hosek-wilkie\" }";
    let alone = parse(alone).unwrap();
    let scene = example("sun and moon");
    assert_eq!((scene.suns.len(), &scene.suns[0]), (3, &alone.suns[0]));
    assert_eq!((scene.suns[1].angular_diameter, scene.suns[2].angular_diameter), (0.52, 0.53));
    assert_eq!(scene.suns[2].irradiance, Spectrum::Constant(0.1));
    let up = Axis::Z;
    let [all, first] = [&scene.suns, &alone.suns].map(|suns| Daylight::new(suns, &scene.sky, up));
    let others = Daylight::new(&scene.suns[1..], &SkyDescription::default(), up);
    assert_eq!(all.sky_level, first.sky_level);
    // Sums of a few numbers in double precision.
    assert!((all.sun / (first.sun + others.sun) - 1.0).abs() < 1e-12);
    assert!((all.sun_level / (first.sun_level + others.sun_level) - 1.0).abs() < 1e-12);
    let moon = Daylight::new(&scene.suns[1..2], &SkyDescription::default(), up);
    assert_eq!(moon.sun_level, others.sun_level, "what is below the horizon lights no level ground");
    assert!(parse("sun = []").unwrap().suns.is_empty());
}

/// What is wrong with suns and clear skies.
#[rustfmt::skip]
const WRONG: &[Wrong] = &[
    ("[sun]\nirradiance = 1", 1, 1, "[sun] has no `direction`"),
    ("[sun]\ndirection = [0, 0, 1]", 1, 1, "[sun] has no `irradiance`"),
    ("[sun]\ndirection = [0, 0, 1]\nirradiance = { blackbody = 5778 }", 3, 14, "[sun.irradiance] has no `illuminance`"),
    ("[sun]\ndirection = [0, 0, 1]\nirradiance = { illuminance = 9 }", 3, 14, "[sun.irradiance] has no `blackbody`"),
    ("[sun]\ndirection = [0, 0, 0]\nirradiance = 1", 2, 13, "[0, 0, 0]: write a direction that is not zero"),
    ("[sun]\ndirection = [0, 0, 1]\nirradiance = 1\nangular_diameter = 0", 4, 20, "write an angle between 0 and 180"),
    ("[sun]\ndirection = [0, 0, 1]\nirradiance = -1", 3, 14, "sun.irradiance: -1: write a number that is not below"),
    ("[sun]\ndirection = [0, 0, 1]\nirradiance = { blackbody = 20, illuminance = 1 }", 3, 28,
     "write a temperature from 500 to 1e6 kelvin"),
    ("[sun]\nelevation = 30", 1, 1, "[sun] has no `azimuth`: write the degrees from north by east"),
    ("[sun]\nelevaton = 30\nazimuth = 9", 2, 1, "unknown key `elevaton` in [sun]; did you mean `elevation`?"),
    ("[sun]\ndirection = [0, 0, 1]\nnorth = [1, 0, 0]\nirradiance = 1", 3, 1, "unknown key `north` in [sun]"),
    ("[sun]\ndate = '2026-06-21'", 1, 1, "[sun] has no `time`: write for example \"14:30\" (UTC)"),
    ("[sun]\ndate = '2026-06-21'\ntime = '14:30'\nlongitude = 3", 1, 1, "[sun] has no `latitude`"),
    ("[sun]\ndirection = [0, 0, 1]\nirradiance = { table = 'astm-g173', scal = 2 }", 3, 37, "did you mean `scale`?"),
    ("[sun]\ndirection = [0, 0, 1]\n[sky]\nradiance = { model = 'hosek-wilkie', turbidty = 2 }", 4, 38,
     "did you mean `turbidity`?"),
    ("[sun]\nelevation = 91\nazimuth = 0", 2, 13, "sun.elevation: 91: write an angle from -90 to 90 degrees"),
    ("[sun]\nelevation = nan\nazimuth = 0", 2, 13, "sun.elevation: nan: write an angle from -90 to 90 degrees"),
    ("[sun]\nelevation = 1\nazimuth = 361", 3, 11, "sun.azimuth: 361: write an angle from -360 to 360 degrees"),
    ("[sun]\nelevation = 1\nazimuth = 1\nnorth = [0, 0, 1]", 4, 9, "[0, 0, 1]: write a direction that is not upright"),
    ("[sun]\ndate = '2026-02-30'\ntime = '12:00'\nlatitude = 1\nlongitude = 1", 2, 8,
     "sun.date: '2026-02-30': write a date of the years 1900 to 2100, such as \"2026-06-21\", that is in the calendar"),
    ("[sun]\ndate = '2025-02-29'\ntime = '12:00'\nlatitude = 1\nlongitude = 1", 2, 8, "that is in the calendar"),
    ("[sun]\ndate = '21.6.2026'\ntime = '12:00'\nlatitude = 1\nlongitude = 1", 2, 8, "that is in the calendar"),
    ("[sun]\ndate = '1899-12-31'\ntime = '12:00'\nlatitude = 1\nlongitude = 1", 2, 8, "of the years 1900 to 2100"),
    ("[sun]\ndate = 2026-06-21\ntime = '12:00'\nlatitude = 1\nlongitude = 1", 2, 8, "\"2026-06-21\", in quotes"),
    ("[sun]\ndate = '2026-06-21'\ntime = '24:00'\nlatitude = 1\nlongitude = 1", 3, 8, "sun.time: '24:00': write a time"),
    ("[sun]\ndate = '2026-06-21'\ntime = '12:00+2'\nlatitude = 1\nlongitude = 1", 3, 8, "or \"14:30+02:00\", in quotes"),
    ("[sun]\ndate = '2026-06-21'\ntime = 12\nlatitude = 1\nlongitude = 1", 3, 8, "sun.time: 12: write a time"),
    ("[sun]\ndate = '2026-06-21'\ntime = '12:00'\nlatitude = 91\nlongitude = 1", 4, 12,
     "sun.latitude: 91: write an angle from -90 to 90 degrees"),
    ("[sun]\ndate = '2026-06-21'\ntime = '12:00'\nlatitude = 1\nlongitude = 400", 5, 13, "sun.longitude: 400"),
    ("[sun]\ndirection = [0, 0, 1]\nirradiance = { table = 'am0' }", 3, 24, "write one of `astm-g173`"),
    ("[sun]\ndirection = [0, 0, 1]\nirradiance = { table = 'astm-g173', scale = -1 }", 3, 45, "write a number that is not below"),
    ("[sun]\ndirection = [0, 0, 1]\n[sky]\nradiance = { model = 'hosek' }", 4, 22, "did you mean `hosek-wilkie`?"),
    ("[sun]\ndirection = [0, 0, 1]\n[sky]\nradiance = { model = 'hosek-wilkie', turbidity = 0 }", 4, 50,
     "sky.radiance.turbidity: 0: write a turbidity from 1 to 10"),
    ("[sun]\ndirection = [0, 0, 1]\n[sky]\nradiance = { model = 'hosek-wilkie', turbidity = nan }", 4, 50, "from 1 to 10"),
    ("[sun]\ndirection = [0, 0, 1]\n[sky]\nradiance = { model = 'hosek-wilkie', ground_albedo = 1.5 }", 4, 54,
     "sky.radiance.ground_albedo: 1.5: write a number from 0 to 1"),
    ("[sun]\ndirection = [0, 0, 1]\nelevation = 3\nirradiance = 1", 3, 13, "the sun has one place: remove this, or what"),
    ("[sun]\nelevation = 3\nazimuth = 0\ndate = '2026-06-21'\nirradiance = 1", 4, 8, "the sun has one place"),
    ("[sun]\ndate = '2026-12-21'\ntime = '11:00'\nlatitude = 69.65\nlongitude = 18.96\nirradiance = 1", 3, 8,
     "sun.time: '11:00': the sun is 2.94 degrees below the horizon then: write a time of the day"),
    ("[sky]\nradiance = { model = 'hosek-wilkie' }", 2, 12, "the light of this sky comes from the sun: add [sun] with"),
    ("[sky]\nradiance = { model = 'hosek-wilkie' }\n[sun]\ndirection = [1, 0, -0.1]", 3, 1,
     "the sun is 5.71 degrees below the horizon, and the sky's model is of the day"),
    ("sun = 3", 1, 7, "sun: 3: write a table [sun], or several with the heading [[sun]]"),
    ("sun = [3]", 1, 8, "sun[0]: 3: write a table [sun], or several with the heading [[sun]]"),
    ("[[sun]]\ndirection = [0, 0, 1]\nirradiance = 1\n[[sun]]\nirradiance = 1", 4, 1, "sun[1] has no `direction`"),
    ("[[sun]]\ndirection = [0, 0, 1]\nirradiance = 1\n[[sun]]\ndirection = [0, 0, 0]\nirradiance = 1", 5, 13,
     "sun[1].direction: [0, 0, 0]: write a direction that is not zero"),
    ("[[sun]]\ndirection = [0, 0, 1]\nirradiance = 1\n[[sun]]\ndirecton = [0, 0, 1]", 5, 1,
     "unknown key `directon` in sun[1]; did you mean `direction`?"),
    ("[[sun]]\ndirection = [0, 0, 1]\nirradiance = { illuminance = 9 }", 3, 14, "sun[0].irradiance has no `blackbody`"),
    ("[[sun]]\ndirection = [0, 0, 1]\n[[sun]]\ndirection = [1, 0, 1]\n[sky]\nradiance = { model = 'hosek-wilkie' }", 3, 1,
     "sun[1] has no `irradiance`: write for example [1.0, 0.95, 0.85] or { table = \"astm-g173\" }; the model of a clear sky in \
      [sky] has that of the first sun alone"),
    ("[[sun]]\ndirection = [1, 0, -0.1]\n[[sun]]\ndirection = [0, 0, 1]\n[sky]\nradiance = { model = 'hosek-wilkie' }", 1, 1,
     "the sun is 5.71 degrees below the horizon, and the sky's model is of the day"),
    ("sun = []\n[sky]\nradiance = { model = 'hosek-wilkie' }", 3, 12, "the light of this sky comes from the sun: add [sun] with"),
    ("[sun]\ndirection = [0, 0, 1]\nirradiance = 1\n[[sun]]\ndirection = [0, 1, 1]\nirradiance = 1", 4, 3, "duplicate key"),
];

#[test]
fn every_wrong_sun_is_named_with_its_place() {
    assert_wrong(WRONG);
}

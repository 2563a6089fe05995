use quick_xml::Reader;
use quick_xml::events::Event;

use super::*;

fn series(name: &str, factor: f64, slope: f64, style: Style) -> Series {
    let point = |i: i32| {
        let x = 0.05 * f64::from(1 << i);
        let y = factor * x.powf(slope) * (1.0 + 0.04 * f64::from(i % 3));
        Point { y_range: Some([0.85 * y, 1.2 * y]), ..Point::new(x, y) }
    };
    Series { name: name.into(), points: (0..7).map(point).collect(), style }
}

fn plot() -> Plot {
    Plot {
        title: "Iceberg & waves, frame 6".into(),
        x: Axis::logarithmic("CPU time / s"),
        y: Axis::logarithmic("RMSE"),
        series: vec![
            series("path", 0.03, -0.5, Style::MarksAndLine),
            series("path, split = 2", 0.024, -0.55, Style::MarksAndLine),
            series("photon", 0.014, -0.33, Style::MarksAndLine),
            series("measured <elsewhere>", 0.0134, -0.33, Style::Marks),
            series("closed form", 0.009, -0.5, Style::Line),
        ],
        guides: vec![
            Guide::Slope { slope: -0.5, through: [0.05, 0.02], label: "slope \u{2212}1/2".into() },
            Guide::Level { y: 0.0021, label: "noise of the reference".into() },
            Guide::Level { y: 1e-9, label: "far below".into() },
        ],
    }
}

/// The names of all elements, and all texts; fails where the text is not well formed.
pub fn parsed(svg: &str) -> (Vec<String>, Vec<String>) {
    let mut reader = Reader::from_str(svg);
    reader.config_mut().check_end_names = true;
    let (mut names, mut texts, mut depth) = (Vec::new(), Vec::new(), 0);
    loop {
        match reader.read_event().unwrap() {
            Event::Start(tag) | Event::Empty(tag) if tag.attributes().any(|a| a.is_err()) => {
                panic!("{tag:?}")
            }
            Event::Start(tag) => {
                depth += 1;
                names.push(tag.name().as_ref().to_owned());
            }
            Event::Empty(tag) => names.push(tag.name().as_ref().to_owned()),
            Event::End(_) => depth -= 1,
            Event::Text(text) => texts.push(String::from(&*text)),
            Event::Eof => break,
            _ => (),
        }
    }
    assert_eq!(depth, 0);
    (names, texts)
}

#[test]
fn the_file_is_well_formed_and_needs_nothing_else() {
    let svg = plot().svg();
    let (names, texts) = parsed(&svg);
    assert_eq!(names[0], "svg");
    let count = |name: &str| names.iter().filter(|n| *n == name).count();
    // Seven circles and one beside the name.
    assert_eq!((count("circle"), count("polygon"), count("title")), (8, 24, 1));
    for text in ["path", "closed form", "CPU time / s", "RMSE", "noise of the reference"] {
        assert!(texts.iter().any(|t| t == text), "{text} of {texts:?}");
    }
    assert!(svg.contains("measured &lt;elsewhere&gt;") && svg.contains("Iceberg &amp; waves"), "{svg}");
    assert!(!svg.contains("far below"), "{svg}");
    // The name space is the only address.
    assert_eq!((svg.matches("http").count(), svg.matches("href").count(), count("script")), (1, 0, 0));
    assert_eq!(svg, plot().svg());
}

#[test]
fn what_has_no_place_is_left_out() {
    let mut plot = plot();
    plot.series.truncate(1);
    for (i, y) in [(1, 0.0), (2, -1.0), (3, f64::NAN), (4, f64::INFINITY)] {
        plot.series[0].points[i].y = y;
    }
    plot.series[0].points[0].y_range = Some([-1.0, f64::INFINITY]);
    let svg = plot.svg();
    let (names, _) = parsed(&svg);
    assert_eq!(names.iter().filter(|n| *n == "circle").count(), 4);
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    plot.series.clear();
    plot.guides.clear();
    parsed(&plot.svg());
}

/// The dashed line leaves the field at its edges only, and has the slope that it says.
#[test]
fn a_slope_is_as_steep_as_it_says() {
    let svg = plot().svg();
    let line = svg.lines().find(|line| line.contains("dasharray=\"7 4\"")).unwrap();
    let path = line.split('"').nth(1).unwrap();
    let numbers: Vec<f64> = path[1..].split(['L', ' ']).map(|n| n.parse().unwrap()).collect();
    let [ax, ay, bx, by] = numbers[..] else { panic!("{path}") };
    let decades = |at: f64, low: f64| at.log10() - low.log10();
    let plot = plot();
    let drawing = draw::Drawing::of(&plot);
    let (x, y) = drawing.axes();
    let horizontal = decades(3.2, 0.05) / (x.at(3.2).unwrap() - x.at(0.05).unwrap()) * (bx - ax);
    let vertical = decades(0.1, 0.01) / (y.at(0.1).unwrap() - y.at(0.01).unwrap()) * (by - ay);
    // Ends are written to a hundredth of a pixel.
    assert!((vertical / horizontal + 0.5).abs() < 1e-3, "{path}");
    assert!(
        (66.0..=486.0).contains(&ax) && (66.0..=486.0).contains(&bx) && ay >= 38.0 && by <= 338.0,
        "{path}"
    );
}

fn polar() -> Polar {
    let lobe = |g: f64| {
        let density =
            move |i: i32| (1.0 - g * g) / (1.0 + g * g - 2.0 * g * f64::from(i).to_radians().cos()).powf(1.5);
        (0..=180).map(|i| Point::new(f64::from(i), density(i))).collect()
    };
    let series = |name: &str, g: f64, style| Series { name: name.into(), points: lobe(g), style };
    Polar {
        title: "Lobes".into(),
        radius: Axis::logarithmic("4 \u{3c0} p"),
        series: vec![
            series("g = 0.9", 0.9, Style::Line),
            series("g = 0.5", 0.5, Style::Line),
            series("g = 0.8", 0.8, Style::Dashes),
        ],
    }
}

/// The x and y of every corner of the path in a line of the file.
fn corners(line: &str) -> Vec<[f64; 2]> {
    let path = line.split('"').nth(1).unwrap();
    let corner = |text: &str| {
        let (x, y) = text.split_once(' ').unwrap();
        [x.parse().unwrap(), y.parse().unwrap()]
    };
    path[1..].split('L').map(corner).collect()
}

#[test]
fn a_polar_diagram_has_straight_on_to_the_right() {
    let svg = polar().svg();
    let (_, texts) = parsed(&svg);
    for text in ["Lobes", "0°", "90°", "180°", "g = 0.9", "4 \u{3c0} p"] {
        assert!(texts.iter().any(|t| t == text), "{text} of {texts:?}");
    }
    assert_eq!(svg, polar().svg());
    // The first is drawn last.
    let lines: Vec<&str> = svg.lines().filter(|line| line.contains("stroke-linejoin")).collect();
    assert!(lines.len() == 3 && lines[0].contains("stroke-dasharray"), "{svg}");
    for line in &lines {
        let corners = corners(line);
        let ([first_x, first_y], [last_x, last_y]) = (corners[0], corners[corners.len() - 1]);
        assert!(first_x > 276.0 && last_x < 276.0 && first_x - 276.0 > 276.0 - last_x, "{line}");
        // Points nobody could tell from the last one are left out.
        assert!((first_y - 292.0).abs() < 1e-9 && (last_y - 292.0).abs() < 0.42, "{line}");
        let from_middle = corners.iter().map(|[x, y]| (x - 276.0).hypot(y - 292.0));
        assert!(from_middle.clone().fold(0.0, f64::max) < 210.0 && corners.iter().all(|[_, y]| *y <= 292.01));
    }
    // A dashed series looks like the one that it is compared with: here the first.
    assert_eq!(svg.matches("<g fill=\"#0072B2\" stroke=\"#0072B2\">").count(), 4);
}

#[test]
fn what_has_no_place_in_a_polar_diagram_is_left_out() {
    let mut plot = polar();
    plot.series.truncate(1);
    for (i, (x, y)) in [(-1.0, 1.0), (200.0, 1.0), (10.0, 0.0), (20.0, f64::NAN)].into_iter().enumerate() {
        plot.series[0].points[60 + i] = Point::new(x, y);
    }
    let svg = plot.svg();
    parsed(&svg);
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    plot.series.clear();
    parsed(&plot.svg());
}

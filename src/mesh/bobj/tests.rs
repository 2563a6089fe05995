use super::*;
use crate::mesh::VelocityName;

fn file(positions: &[[f32; 3]], normals: Option<&[[f32; 3]]>, triangles: &[[i32; 3]]) -> Vec<u8> {
    let count = |n: usize| (n as i32).to_le_bytes();
    let floats =
        |list: &[[f32; 3]]| list.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let mut file = [&count(positions.len())[..], &floats(positions)].concat();
    if let Some(normals) = normals {
        file.extend([&count(normals.len())[..], &floats(normals)].concat());
    }
    file.extend(count(triangles.len()));
    file.extend(triangles.as_flattened().iter().flat_map(|i| i.to_le_bytes()));
    file
}

const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

#[test]
fn the_length_tells_the_two_solvers_apart() {
    let up = [[0.0, 0.0, 1.0]; 3];
    for (normals, expected) in [(None, false), (Some(&[][..]), false), (Some(&up[..]), true)] {
        let mesh = read(&file(&CORNERS, normals, &[[0, 1, 2], [2, 1, 0]])).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 0]]);
        assert_eq!(mesh.positions, CORNERS.map(|p| Vec3::from_array(p).as_dvec3()));
        assert_eq!(mesh.normals.is_some(), expected);
    }
}

#[test]
fn what_contradicts_itself_is_refused_with_the_place() {
    let message = |bytes: &[u8]| {
        let fault = read(bytes).unwrap_err();
        format!("{}{}", fault.place, fault.problem)
    };
    assert_eq!(
        message(&file(&CORNERS, None, &[[0, 1, 3]])),
        "triangle 0: vertex index 3, but there are 3 vertices"
    );
    assert!(
        message(&file(&CORNERS, None, &[[0, 1, 2], [0, -1, 2]])).starts_with("triangle 1: vertex index -1")
    );
    assert!(message(&file(&CORNERS, Some(&[[0.0; 3]; 2]), &[])).contains("2 normals for 3 vertices"));
    assert!(message(&file(&[[0.0, f32::NAN, 0.0]], None, &[])).starts_with("vertex 0: the coordinates"));
    let mut huge = file(&CORNERS, None, &[]);
    huge[..4].copy_from_slice(&170_000_000_i32.to_le_bytes());
    assert!(message(&huge).contains("170000000 are declared, at most 3 fit"));
    huge[..4].copy_from_slice(&(-1_i32).to_le_bytes());
    assert!(message(&huge).contains("-1 elements are declared"));
}

#[test]
fn every_truncation_is_an_error() {
    for normals in [None, Some(&[[0.0, 0.0, 1.0]; 3][..])] {
        let file = file(&CORNERS, normals, &[[0, 1, 2]]);
        for length in 0..file.len() {
            assert!(read(&file[..length]).is_err(), "{length}");
        }
    }
}

#[test]
fn velocities_come_from_the_file_beside() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = folder.path().join("000012.bobj");
    assert_eq!(velocity_file(&mesh), None);
    let beside = folder.path().join("velocity000012.bobj");
    std::fs::write(&beside, file(&CORNERS, None, &[])).unwrap();
    assert_eq!(velocity_file(&mesh), Some(beside.clone()));
    assert_eq!(velocity_file(&folder.path().join("000012.BOBJ.gz")), None);
    assert_eq!(velocity_file(&folder.path().join("000012.bobj.GZ")), Some(beside.clone()));

    std::fs::write(&mesh, file(&CORNERS, None, &[[0, 1, 2]])).unwrap();
    let velocities = |name| crate::mesh::read_with(&mesh, &name).map(|mesh| mesh.velocities);
    let known = velocities(VelocityName::Known).unwrap();
    assert_eq!(known, Some(CORNERS.map(Vec3::from_array).to_vec()));
    assert_eq!(velocities(VelocityName::Nothing).unwrap(), None);
    std::fs::write(&beside, file(&CORNERS[..2], None, &[])).unwrap();
    let message = velocities(VelocityName::Known).unwrap_err().to_string();
    assert!(message.contains("velocity000012.bobj: 2 velocities, but the mesh has 3 vertices"), "{message}");
}

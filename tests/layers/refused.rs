//! What cannot be rendered is said.

use glam::DVec3;

use crate::common::mesh::cuboid;
use crate::common::scene::SceneFolder;

#[test]
fn more_meshes_than_a_ray_keeps_account_of() {
    let folder = SceneFolder::new().mesh("box.ply", &cuboid(DVec3::ZERO, DVec3::ONE));
    let meshes = |count: usize| {
        let one = |i: usize| {
            format!(
                "[[meshes]]\npath = \"box.ply\"\ninside = \"air\"\ntransform = {{ translate = [{}, 0, 0] }}\n",
                i as f64 * 0.5
            )
        };
        "[camera]\neye = [0, -4, 1]\ntarget = [0, 0, 0]\n".to_owned()
            + &(0..count).map(one).collect::<String>()
    };
    assert!(folder.scene(&meshes(64)).frame.needs.layers);
    let error = folder.not_assembled(&meshes(65));
    assert!(
        error.to_string().contains("more than 64 regions: write some of them as one labelled mesh"),
        "{error}"
    );
}

#[test]
fn labels_that_nobody_named() {
    let labelled = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                    element face 1\nproperty list uchar int vertex_indices\nproperty int label_front\n\
                    property int label_back\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0 3\n";
    let folder = SceneFolder::new().file("ice.ply", labelled.as_bytes());
    let scene = |more: &str| {
        format!("[camera]\neye = [0, -4, 1]\ntarget = [0, 0, 0]\n[[meshes]]\npath = \"ice.ply\"\n{more}\n")
    };
    let error = folder.refused(&scene("inside = \"air\""));
    assert!(error.to_string().contains("its triangles carry labels: in "), "{error}");
    let error = folder.refused(&scene("regions = { 1 = \"air\" }"));
    assert!(error.to_string().contains("label 3 has no medium; add `3 = \"NAME\"` to regions"), "{error}");
}

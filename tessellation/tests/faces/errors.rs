//! The proven error against dense samples.

use perpend_tessellation::{Limits, tessellate};
use proptest::prelude::*;

use crate::oracle::{distance_to_mesh, largest_deviation, spread, surfaces};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    #[test]
    fn no_point_of_surface_or_mesh_is_farther_than_the_error(surface in surfaces(), share in 0.002..0.2_f64) {
        let size = surface.control_box().diagonal();
        let chord = share * size;
        let mesh = tessellate(&surface, None, chord, Limits::default()).unwrap();
        prop_assert!(mesh.error <= chord);
        let rounding = 1e-14 * (size + surface.control_box().reach());
        prop_assert!(largest_deviation(&surface, &mesh) <= mesh.error + rounding);
        for at in spread(&surface, 13) {
            let distance = distance_to_mesh(surface.point(at.x, at.y), &mesh);
            prop_assert!(distance <= mesh.error + rounding, "{at}: {distance} > {}", mesh.error);
        }
        for (at, vertex) in mesh.parameters.iter().zip(&mesh.vertices) {
            prop_assert_eq!(surface.point(at.x, at.y), *vertex);
        }
        for normal in &mesh.normals {
            prop_assert!((normal.length() - 1.0).abs() < 1e-12 || normal.length() == 0.0);
        }
        // every inner side is shared, and run through both ways
        prop_assert_eq!(tessellate(&surface, None, chord, Limits::default()).unwrap(), mesh);
    }
}

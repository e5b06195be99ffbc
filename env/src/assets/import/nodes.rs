//! Walks the node tree and finds the pose of every mesh. Refuses cycles, nodes with two parents and excessive depth.

use gltf_json::{Index, Mesh, Node, Root};

use super::limits::MAX_IMPORT_DEPTH;
use super::refusal::{named, one_of, refuse};
use crate::EnvError;
use crate::vector::cross;

/// The pose of a mesh: the upper three rows of a 4 × 4 matrix from its frame to the scene's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose([[f64; 4]; 3]);

type Visitor<'a> = dyn FnMut(Index<Mesh>, &Pose, &str) -> Result<(), EnvError> + 'a;

/// Visits every mesh of the default scene, or of the whole tree if there are no scenes, with its pose and the path of its node.
pub(super) fn visit(root: &Root, visitor: &mut Visitor) -> Result<(), EnvError> {
    let mut walk = Walk {
        root,
        seen: vec![false; root.nodes.len()],
        visitor,
    };
    let scene = root.scene.map_or(0, |scene| scene.value());
    if let Some(scene_root) = root.scenes.get(scene) {
        for node in &scene_root.nodes {
            walk.node(*node, &Pose::IDENTITY, 1, &format!("/scenes/{scene}/nodes"))?;
        }
        return Ok(());
    }
    if !root.scenes.is_empty() || root.scene.is_some() {
        return Err(refuse("/scene", scene.to_string(), one_of(root.scenes.len())));
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().filter_map(|node| node.children.as_ref()).flatten() {
        if let Some(is_child) = is_child.get_mut(child.value()) {
            *is_child = true;
        }
    }
    for (index, is_child) in is_child.iter().enumerate() {
        if !is_child {
            walk.node(Index::new(index as u32), &Pose::IDENTITY, 1, "/nodes")?;
        }
    }
    Ok(())
}

struct Walk<'a, 'b> {
    root: &'a Root,
    seen: Vec<bool>,
    visitor: &'a mut Visitor<'b>,
}

impl Walk<'_, '_> {
    fn node(&mut self, index: Index<Node>, parent: &Pose, depth: usize, from: &str) -> Result<(), EnvError> {
        let index = index.value();
        let node = named(&self.root.nodes, index, "node", from)?;
        let place = format!("/nodes/{index}");
        if std::mem::replace(&mut self.seen[index], true) {
            return Err(refuse(
                place,
                "a node with two parents, or in a cycle",
                "a tree of nodes",
            ));
        }
        if depth > MAX_IMPORT_DEPTH {
            let found = format!("a node {depth} deep");
            return Err(refuse(place, found, format!("at most {MAX_IMPORT_DEPTH}")));
        }
        let own = Pose::of(node);
        if !own.0.as_flattened().iter().all(|number| number.is_finite()) {
            return Err(refuse(place, "a transform that is not finite", "finite numbers"));
        }
        let pose = parent.then(&own);
        if let Some(mesh) = node.mesh {
            (self.visitor)(mesh, &pose, &place)?;
        }
        for child in node.children.iter().flatten() {
            self.node(*child, &pose, depth + 1, &format!("{place}/children"))?;
        }
        Ok(())
    }
}

impl Pose {
    pub(super) const IDENTITY: Self = Self([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);

    /// A node's local transform: its matrix, or scale, then rotation, then translation.
    fn of(node: &Node) -> Self {
        if let Some(columns) = node.matrix {
            let row = |row: usize| [0, 1, 2, 3].map(|column| f64::from(columns[4 * column + row]));
            return Self([row(0), row(1), row(2)]);
        }
        let [tx, ty, tz] = node.translation.unwrap_or([0.0; 3]).map(f64::from);
        let [sx, sy, sz] = node.scale.unwrap_or([1.0; 3]).map(f64::from);
        let quaternion = node
            .rotation
            .as_ref()
            .map_or([0.0, 0.0, 0.0, 1.0], |rotation| rotation.0);
        let quaternion = quaternion.map(f64::from);
        let length = quaternion.iter().map(|part| part * part).sum::<f64>().sqrt();
        let [x, y, z, w] = if length > 0.0 {
            quaternion.map(|part| part / length)
        } else {
            [0.0, 0.0, 0.0, 1.0]
        };
        Self([
            [
                (1.0 - 2.0 * (y * y + z * z)) * sx,
                2.0 * (x * y - z * w) * sy,
                2.0 * (x * z + y * w) * sz,
                tx,
            ],
            [
                2.0 * (x * y + z * w) * sx,
                (1.0 - 2.0 * (x * x + z * z)) * sy,
                2.0 * (y * z - x * w) * sz,
                ty,
            ],
            [
                2.0 * (x * z - y * w) * sx,
                2.0 * (y * z + x * w) * sy,
                (1.0 - 2.0 * (x * x + y * y)) * sz,
                tz,
            ],
        ])
    }

    /// The pose of a `child` given in this frame.
    fn then(&self, child: &Self) -> Self {
        let entry = |row: &[f64; 4], column: usize| {
            let along: f64 = (0..3).map(|k| row[k] * child.0[k][column]).sum();
            along + if column == 3 { row[3] } else { 0.0 }
        };
        Self(self.0.map(|row| [0, 1, 2, 3].map(|column| entry(&row, column))))
    }

    pub(super) fn apply(&self, [x, y, z]: [f32; 3]) -> [f64; 3] {
        let [x, y, z] = [f64::from(x), f64::from(y), f64::from(z)];
        self.0.map(|[a, b, c, d]| a * x + b * y + c * z + d)
    }

    /// Whether the transform is a reflection, so that the winding of triangles must be reversed.
    pub(super) fn mirrors(&self) -> bool {
        let [a, b, c] = self.0.map(|[x, y, z, _]| [x, y, z]);
        let cross = cross(b, c);
        (0..3).map(|k| a[k] * cross[k]).sum::<f64>() < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(json: &str) -> Node {
        gltf_json::deserialize::from_str(json).expect("the node is valid JSON")
    }

    #[test]
    fn transform_applies_scale_then_rotation_then_translation() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let json = format!(r#"{{"translation": [1, 2, 3], "rotation": [0, 0, {half}, {half}], "scale": [2, 1, 1]}}"#);
        let found = Pose::of(&node(&json)).apply([1.0, 0.0, 0.0]);
        let error: f64 = (0..3).map(|k| (found[k] - [1.0, 4.0, 3.0][k]).abs()).sum();
        assert!(error < 1e-6, "{found:?}");
    }

    #[test]
    fn matrices_are_read_in_column_major_order() {
        let pose = Pose::of(&node(r#"{"matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 5,6,7,1]}"#));
        assert_eq!(pose.apply([1.0, 0.0, 0.0]), [5.0, 7.0, 7.0]);
        assert!(!pose.mirrors());
        assert!(Pose::of(&node(r#"{"scale": [1, -1, 1]}"#)).mirrors());
        assert_eq!(Pose::IDENTITY.then(&pose), pose);
    }
}

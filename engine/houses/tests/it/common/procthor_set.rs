//! A house in ProcTHOR's form, and the table of its assets.

use serde_json::{Value, json};

/// A place or a size.
pub(crate) fn xyz(x: f64, y: f64, z: f64) -> Value {
    json!({"x": x, "y": y, "z": z})
}

fn wall(id: &str, room: &str, from: [f64; 2], to: [f64; 2]) -> Value {
    let [a, b] = [from, to];
    json!({
        "id": id, "roomId": room, "material": {"name": "PureWhite", "color": {"r": 0.5, "g": 0.25, "b": 1.0}},
        "polygon": [xyz(a[0], 0.0, a[1]), xyz(b[0], 0.0, b[1]), xyz(b[0], 2.5, b[1]), xyz(a[0], 2.5, a[1])],
    })
}

/// A kitchen (x 0 to 4, z 0 to 3) and, behind it, a bedroom (z 3 to 6) that is L-shaped (x 0 to 4, but to 2 from z 5 on).
/// Unity's z points forwards.
pub(crate) fn file() -> Value {
    let kitchen = [[0.0, 0.0], [0.0, 3.0], [4.0, 3.0], [4.0, 0.0]];
    let bedroom = [
        [0.0, 3.0],
        [0.0, 6.0],
        [2.0, 6.0],
        [2.0, 5.0],
        [4.0, 5.0],
        [4.0, 3.0],
    ];
    let floor = |corners: &[[f64; 2]]| -> Vec<Value> {
        corners.iter().map(|c| xyz(c[0], 0.0, c[1])).collect()
    };
    let around = |room: &str, corners: &[[f64; 2]]| -> Vec<Value> {
        let count = corners.len();
        (0..count)
            .map(|k| {
                wall(
                    &format!("{room}{k}"),
                    room,
                    corners[k],
                    corners[(k + 1) % count],
                )
            })
            .collect()
    };
    let mut walls = around("room|1", &kitchen);
    walls.extend(around("room|2", &bedroom));
    walls.push(wall("outer", "exterior", [0.0, 3.0], [0.0, 0.0]));
    json!({
        "rooms": [
            {"id": "room|1", "roomType": "Kitchen", "floorMaterial": {"name": "BrownMarbleFake 1"}, "floorPolygon": floor(&kitchen)},
            {"id": "room|2", "roomType": "Bedroom", "floorMaterial": "DarkWoodFloors", "floorPolygon": floor(&bedroom)},
        ],
        "walls": walls,
        // From (0, 3) to (4, 3) runs the kitchen's second wall; the bedroom's last one runs back.
        "doors": [{
            "id": "door|1|2", "assetId": "Doorway_4", "room0": "room|1", "room1": "room|2",
            "wall0": "room|11", "wall1": "room|25", "openable": true, "openness": 1.0,
            "holePolygon": [xyz(0.5, 0.0, 0.0), xyz(1.5, 2.1, 0.0)],
        }],
        "windows": [{
            "id": "window|1", "assetId": "Window_Fixed_48x36", "room0": "room|1", "room1": null,
            "wall0": "room|10", "wall1": "outer",
            "holePolygon": [xyz(1.0, 0.9, 0.0), xyz(2.2, 1.8, 0.0)],
        }],
        "objects": [
            {
                "id": "DiningTable|1|0", "assetId": "Dining_Table_1", "kinematic": true,
                "position": xyz(2.5, 0.4, 1.5), "rotation": xyz(0.0, 90.0, 0.0),
                "children": [{
                    "id": "Mug|surface|1", "assetId": "Mug_3", "kinematic": false,
                    "position": xyz(2.5, 0.85, 1.5), "rotation": xyz(0.0, 0.0, 0.0),
                }],
            },
            {"id": "Bed|2|0", "assetId": "Bed_7", "position": xyz(1.0, 0.3, 4.6), "rotation": xyz(0.0, 180.0, 0.0), "kinematic": true},
            {"id": "Sofa|2|1", "assetId": "Sofa_9", "position": xyz(3.0, 0.45, 3.6), "rotation": xyz(0.0, 0.0, 0.0)},
            {"id": "Watch|2|2", "assetId": "Watch_1", "position": xyz(3.0, 0.02, 4.6), "rotation": null},
            {"id": "Gizmo|2|3", "assetId": "Gizmo_1", "position": xyz(3.5, 0.5, 4.6)},
        ],
        "proceduralParameters": {
            "ceilingMaterial": {"name": "PureWhite"},
            "lights": [
                {"id": "DirectionalLight", "type": "directional", "position": xyz(0.0, 1.0, 0.0)},
                {"id": "light|1", "type": "point", "position": xyz(2.0, 2.2, 1.5)},
                {"id": "light|2", "type": "point", "position": xyz(1.0, 2.2, 4.5)},
            ],
        },
        "metadata": {"schema": "1.0.0"},
    })
}

/// Returns what `asset-database.json` says of the house's assets.
pub(crate) fn database() -> Value {
    let row = |id: &str, x: f64, y: f64, z: f64| json!([{"assetId": id, "boundingBox": xyz(x, y, z), "split": "train"}]);
    json!({
        "DiningTable": row("Dining_Table_1", 1.6, 0.8, 0.9),
        "Mug": row("Mug_3", 0.12, 0.1, 0.09),
        "Bed": row("Bed_7", 1.5, 0.6, 2.1),
        "Watch": row("Watch_1", 0.06, 0.04, 0.08),
    })
}

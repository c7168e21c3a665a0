// A case for a circuit board: walls by differences, screw bosses, slots, and the lid
// beside it.
size = [80, 56, 26];
wall = 2.4;
corner = 6;
boss = [31, 19];
$fn = 48;

// A block with round upright edges; cubes and cylinders meet tangentially.
module block(size, r) {
    translate([-size[0] / 2 + r, -size[1] / 2, 0]) cube([size[0] - 2 * r, size[1], size[2]]);
    translate([-size[0] / 2, -size[1] / 2 + r, 0]) cube([size[0], size[1] - 2 * r, size[2]]);
    four(size[0] / 2 - r, size[1] / 2 - r) cylinder(h = size[2], r = r);
}

module four(x, y)
    for (i = [-1, 1], j = [-1, 1]) translate([i * x, j * y, 0]) children();

module case()
    difference() {
        union() {
            difference() {
                block(size, corner);
                translate([0, 0, wall])
                    block([size[0] - 2 * wall, size[1] - 2 * wall, size[2]], corner - wall);
            }
            four(boss[0], boss[1]) cylinder(h = size[2] - 3, r = 4);
            translate([-20, -12, 0]) four(0, 0) cube([40, 24, wall + 1]);
        }
        four(boss[0], boss[1]) translate([0, 0, 6]) cylinder(h = 30, r = 1.5, $fn = 24);
        // slots for air, through front and back
        for (i = [-5 : 5]) translate([i * 4 - 1, -40, 8]) cube([2, 80, 11]);
        // a plug on the right, a cable gland on the left
        translate([30, -6, 7]) cube([20, 12, 6]);
        translate([-50, 0, 13]) rotate([0, 90, 0]) cylinder(h = 20, r = 5);
    }

module lid()
    difference() {
        union() {
            block([size[0], size[1], wall], corner);
            translate([0, 0, wall])
                block([size[0] - 2 * wall - 0.4, size[1] - 2 * wall - 0.4, 2], corner - wall);
        }
        translate([0, 0, wall])
            block([size[0] - 4 * wall, size[1] - 4 * wall, 3], corner - 2 * wall);
        for (i = [-4 : 4]) translate([i * 5 - 1, -12, -1]) cube([2, 24, 5]);
        // countersunk from below, which is the outside
        four(boss[0], boss[1]) {
            translate([0, 0, -1]) cylinder(h = 8, r = 1.8, $fn = 24);
            cylinder(h = 1.8, r1 = 3.6, r2 = 1.8, $fn = 24);
        }
    }

color("darkslategray") translate([-46, 0, 0]) case();
color("darkorange") translate([46, 0, wall + 2]) rotate([180, 0, 0]) lid();

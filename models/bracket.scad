// A printed angle bracket with slotted holes and two webs. The sharp `!` shows the
// bracket alone, as one does while drawing it: the shelf below is not part of the model.
$fn = 40;

module slot(length, r)
    union() {
        square([length, 2 * r], center = true);
        for (x = [-length / 2, length / 2]) translate([x, 0]) circle(r = r);
    }

// One web: a concave outline of thickness 5, faces clockwise from outside.
module web()
    polyhedron(
        points = [
            [0, 0, 0], [0, 38, 0], [0, 38, 5], [0, 15, 15], [0, 5, 38], [0, 0, 38],
            [5, 0, 0], [5, 38, 0], [5, 38, 5], [5, 15, 15], [5, 5, 38], [5, 0, 38]
        ],
        faces = [
            [0, 1, 2, 3, 4, 5], [11, 10, 9, 8, 7, 6],
            [0, 6, 7, 1], [1, 7, 8, 2], [2, 8, 9, 3],
            [3, 9, 10, 4], [4, 10, 11, 5], [5, 11, 6, 0]
        ],
        convexity = 2
    );

module bracket() {
    linear_extrude(height = 6) difference() {       // foot
        translate([-40, 0]) square([80, 56]);
        translate([0, 36]) slot(22, 3.5);
        for (x = [-32, 32]) translate([x, 46]) circle(r = 3);
    }
    translate([0, 6, 6]) rotate([90, 0, 0])         // wall
        linear_extrude(height = 6) difference() {
            polygon([[-40, 0], [40, 0], [40, 36], [26, 50], [-26, 50], [-40, 36]]);
            translate([0, 30]) slot(22, 3.5);
            for (x = [-32, 32]) translate([x, 22]) circle(r = 3);
        }
    for (side = [0, 1]) mirror([side, 0, 0]) translate([19, 6, 6]) web();
}

!color("mediumseagreen") rotate(180) render(convexity = 4) bracket();

translate([-100, -100, -20]) cube([200, 200, 20]);

// A die: a cube worn round by a ball, its pips the lower halves of small balls whose
// centres lie on the faces. Opposite faces add up to seven.
pip = 1.8;
step = 4.6;

module pips(places)
    for (p = places)
        translate([step * p[0], step * p[1], 10]) sphere(r = pip, $fn = 32);

one = [[0, 0]];
two = [[-1, -1], [1, 1]];
three = concat(one, two);
four = [[-1, -1], [-1, 1], [1, -1], [1, 1]];
five = concat(one, four);
six = concat(four, [[-1, 0], [1, 0]]);

difference() {
    intersection() {
        color("ivory") cube(20, center = true);
        color("ivory") sphere(r = 13.8, $fn = 72);
    }
    color("firebrick") {
        pips(five);
        rotate([180, 0, 0]) pips(two);
        rotate([90, 0, 0]) pips(one);
        rotate([-90, 0, 0]) pips(six);
        rotate([0, 90, 0]) pips(three);
        rotate([0, -90, 0]) pips(four);
    }
}

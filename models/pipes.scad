// A pipe manifold: a run with flanged ends, three risers, a drain and an elbow.
// Outside first, then everything that is hollow is taken away at once.
$fn = 48;
run = 60;                           // half the length of the run

module both_ends() {
    children();
    mirror([1, 0, 0]) children();
}

module along_x(h, r, at = 0)
    translate([at, 0, 0]) rotate([0, 90, 0]) cylinder(h = h, r = r);

module riser(h, r) cylinder(h = h, r = r);

module bolt_circle(r, n, hole)
    for (i = [0 : n - 1]) rotate(360 / n * (i + 0.5)) translate([r, 0, -1])
        cylinder(h = 6, r = hole, $fn = 24);

difference() {
    color("steelblue") union() {
        both_ends() along_x(run, 10);
        both_ends() along_x(4, 18, run - 4);
        for (x = [-34, 0, 34]) translate([x, 0, 0]) {
            riser(32, 7);
            translate([0, 0, 28]) cylinder(h = 3, r = 12);
            translate([0, 0, 9]) cylinder(h = 5, r1 = 9.5, r2 = 7);
        }
        translate([17, 0, 0]) rotate([90, 0, 0]) riser(26, 5);
        translate([17, -26, 0]) sphere(r = 5);
        translate([17, -26, -16]) riser(16, 5);
        translate([17, -26, -18]) cylinder(h = 7, r = 8, $fn = 6);
    }
    color("sandybrown") {
        along_x(2 * run + 2, 8, -run - 1);
        for (x = [-34, 0, 34]) translate([x, 0, 0]) riser(40, 5.2);
        translate([17, 0, 0]) rotate([90, 0, 0]) riser(26, 3.4);
        translate([17, -26, 0]) sphere(r = 3.4);
        translate([17, -26, -20]) riser(20, 3.4);
    }
    color("slategray") {
        both_ends() translate([run - 5, 0, 0]) rotate([0, 90, 0]) bolt_circle(14, 6, 2);
        for (x = [-34, 0, 34]) translate([x, 0, 27]) bolt_circle(9.5, 4, 1.3);
    }
}

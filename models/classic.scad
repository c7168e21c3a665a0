// The picture of every lecture on solid modelling: cube and ball, less a cross of
// three cylinders.
$fn = 64;

difference() {
    intersection() {
        color("crimson") cube(20, center = true);
        color("royalblue") sphere(r = 13.5);
    }
    color("limegreen") {
        cylinder(h = 30, r = 7, center = true);
        rotate([90, 0, 0]) cylinder(h = 30, r = 7, center = true);
        rotate([0, 90, 0]) cylinder(h = 30, r = 7, center = true);
    }
}

// An asteroid from asteroid.stl (see meshes.py) with a few fresh craters and a shaft
// bored right through it.
difference() {
    color("gray") import("asteroid.stl", convexity = 4);
    color("silver") {
        translate([-8, -22, 12]) sphere(r = 8, $fn = 40);
        translate([19, -8, -14]) sphere(r = 7, $fn = 40);
        translate([22, 8, 12]) sphere(r = 6, $fn = 40);
        translate([-20, -13, -10]) sphere(r = 5, $fn = 40);
    }
    color("orangered") rotate([51, 0, 21]) cylinder(h = 100, r = 6, center = true, $fn = 40);
}

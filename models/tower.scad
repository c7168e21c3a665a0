// The leaning tower: it leans by a shear, so its floors stay level and its volume is
// that of the upright one.
storeys = 6;
$fn = 60;

module columns(n, at, r, h)
    for (i = [0 : n - 1]) rotate(360 / n * i) translate([at, 0, 0])
        cylinder(h = h, r = r, $fn = 12);

module floor_(r, z) translate([0, 0, z]) cylinder(h = 0.8, r = r);

module tower() difference() {
    union() {
        cylinder(h = 1, r = 12);
        translate([0, 0, 1]) cylinder(h = 8, r = 9);
        translate([0, 0, 1]) columns(15, 10.3, 0.6, 8);
        floor_(11.5, 9);
        for (k = [0 : storeys - 1]) translate([0, 0, 9.8 + 5 * k]) {
            cylinder(h = 4.2, r = 8);
            columns(24, 9.9, 0.4, 4.2);
            floor_(10.8, 4.2);
        }
        translate([0, 0, 9.8 + 5 * storeys]) {
            cylinder(h = 5, r = 5.5);
            columns(12, 7, 0.5, 5);
            floor_(8, 5);
        }
    }
    translate([0, 0, 4]) cylinder(h = 60, r = 4);
}

color("olivedrab") translate([0, 0, -1.5]) cylinder(h = 1.5, r = 20);
color("linen") multmatrix([[1, 0, 0.1, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) tower();

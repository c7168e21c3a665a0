// A weld-neck flange. Every storey stands flush on the one below it.
$fn = 96;
holes = 8;

color("lightsteelblue") difference() {
    union() {
        translate([0, 0, -2]) cylinder(h = 2, r = 32);      // raised face
        cylinder(h = 10, r = 50);                           // disc
        translate([0, 0, 10]) cylinder(h = 18, r1 = 28, r2 = 20);
        translate([0, 0, 28]) cylinder(h = 12, r = 20);     // neck
    }
    translate([0, 0, -5]) cylinder(h = 50, r = 16);         // bore
    for (i = [0 : holes - 1])
        rotate(360 / holes * (i + 0.5)) translate([40, 0, -1])
            cylinder(h = 12, r = 5, $fn = 48);
}

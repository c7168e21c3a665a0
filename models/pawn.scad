// Two pawns on their squares: balls, flattened balls, cylinders and cone frusta.
$fn = 64;
square = 27;

module flat_ball(r, flat) scale([1, 1, flat]) sphere(r = r);

module pawn() {
    cylinder(h = 2.5, r = 11);
    translate([0, 0, 3.5]) flat_ball(10.6, 0.3);
    translate([0, 0, 5]) cylinder(h = 3, r1 = 9.4, r2 = 7.6);
    translate([0, 0, 8]) flat_ball(7.9, 0.16);
    translate([0, 0, 8]) cylinder(h = 5, r1 = 7, r2 = 5.2);
    translate([0, 0, 13]) cylinder(h = 6, r1 = 5.2, r2 = 4);
    translate([0, 0, 19]) cylinder(h = 6, r1 = 4, r2 = 3.5);
    translate([0, 0, 25]) flat_ball(6.4, 0.2);
    translate([0, 0, 26]) cylinder(h = 2, r1 = 4.6, r2 = 3.8);
    translate([0, 0, 32]) sphere(r = 5.8);
}

for (i = [0 : 1], j = [0 : 1])
    color((i + j) % 2 == 0 ? "saddlebrown" : "wheat")
        translate([(i - 1) * square, (j - 1) * square, -4]) cube([square, square, 4]);

color("ghostwhite") translate([-square / 2, -square / 2, 0]) pawn();
color([0.16, 0.15, 0.17]) translate([square / 2, square / 2, 0]) pawn();

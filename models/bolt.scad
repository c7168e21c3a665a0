// Hex bolt, washer and nut. The thread is a stack of rings, not a helix: two cone
// frusta for each turn. The hexagons are cylinders of six sides, and mean it.
flats = 17;                         // width across flats
corner = flats / sqrt(3);           // and to a corner
pitch = 2;
crest = 5;
root = 4;

module ring(crest, root) {
    cylinder(h = pitch / 2, r1 = root, r2 = crest, $fn = 48);
    translate([0, 0, pitch / 2])
        cylinder(h = pitch / 2, r1 = crest, r2 = root, $fn = 48);
}

module thread(crest, root, turns)
    for (i = [0 : turns - 1]) translate([0, 0, i * pitch]) ring(crest, root);

// A hexagon whose corners are turned off by cones from below and above.
module hexagon(h, below, above)
    intersection() {
        cylinder(h = h, r = corner, $fn = 6);
        if (below) cylinder(h = h, r1 = 8.6, r2 = 8.6 + 1.75 * h, $fn = 48);
        if (above) cylinder(h = h, r1 = 8.6 + 1.75 * h, r2 = 8.6, $fn = 48);
    }

color("lightslategray") {
    hexagon(7, true, false);
    translate([0, 0, 7]) cylinder(h = 8, r = crest, $fn = 48);
    translate([0, 0, 15]) thread(crest, root, 12);
    translate([0, 0, 39]) cylinder(h = 1, r1 = root, r2 = root - 0.8, $fn = 48);
}

color("silver") translate([0, 0, 18]) difference() {
    cylinder(h = 1.6, r = 11, $fn = 48);
    translate([0, 0, -1]) cylinder(h = 4, r = 5.4, $fn = 48);
}

color("goldenrod") translate([0, 0, 22]) difference() {
    hexagon(8, true, true);
    translate([0, 0, -1]) thread(crest + 0.15, root + 0.15, 5);
}

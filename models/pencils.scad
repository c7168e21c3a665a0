// Three pencils. A cone with its apex at the point sharpens a six-sided prism, which
// gives the paint its scalloped edge; wood and lead share the cone and the core exactly.
module sharpened(length)
    intersection() {
        children();
        cylinder(h = length, r1 = length / 5, r2 = 0, $fn = 72);
    }

module pencil(paint, lead, length) {
    difference() {
        intersection() {
            color(paint) cylinder(h = length, r = 4, $fn = 6);
            color("burlywood") cylinder(h = length, r1 = length / 5, r2 = 0, $fn = 72);
        }
        cylinder(h = length, r = 1.2, $fn = 24);
    }
    color(lead) sharpened(length) cylinder(h = length, r = 1.2, $fn = 24);
}

module lying(x, turn) translate([x, 0, 2 * sqrt(3)]) rotate(turn) rotate([90, 0, 0])
    translate([0, 0, -35]) children();

lying(-22, -14) pencil("gold", [0.2, 0.2, 0.2], 80);
lying(0, -1) pencil("crimson", "firebrick", 72);
lying(22, 12) pencil("mediumblue", "navy", 64);

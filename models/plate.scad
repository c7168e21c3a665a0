// A perforated sheet with two folded edges: some hundreds of holes in a staggered grid.
length = 160;
width = 100;
thick = 3;

color("lightgray") {
    difference() {
        translate([-length / 2, -width / 2, 0]) cube([length, width, thick]);
        for (j = [-7 : 7])
            for (i = [0 : 22 - abs(j) % 2])
                translate([6 * (i - 11) + 3 * (abs(j) % 2), 5.2 * j, -1])
                    cylinder(h = thick + 2, r = 2, $fn = 24);
        for (x = [-75, 75], y = [-42, 42]) translate([x, y, 0]) {
            translate([0, 0, -1]) cylinder(h = thick + 2, r = 2.2, $fn = 24);
            translate([0, 0, 1]) cylinder(h = 2, r1 = 2.2, r2 = 4.2, $fn = 24);
        }
    }
    for (y = [-50, 48]) translate([-length / 2, y, thick]) cube([length, 2, 7]);
}

// Menger's sponge, three rounds, cut through its centre at right angles to a diagonal.
side = 54;

module bars(s, n)
    for (i = [0 : n - 1], j = [0 : n - 1])
        translate([(i - (n - 1) / 2) * s, (j - (n - 1) / 2) * s, 0])
            cube([s / 3, s / 3, side + 2], center = true);

module drill() {
    bars(side, 1);
    bars(side / 3, 3);
    bars(side / 9, 9);
}

difference() {
    color("khaki") cube(side, center = true);
    color("peru") {
        drill();
        rotate([90, 0, 0]) drill();
        rotate([0, 90, 0]) drill();
    }
    color("indianred") rotate(-45) rotate([0, acos(1 / sqrt(3)), 0])
        translate([-60, -60, 0]) cube(120);
}

// Wheel and pinion with involute teeth. Each outline is one polygon with two paths: the
// teeth and the bore with its keyway; round holes are cut in the plane before extruding.
module_ = 3;
pressure = 20;

function involute(a) = tan(a) * 180 / PI - a;
function half_tooth(r, teeth) =
    let (base = module_ * teeth / 2 * cos(pressure))
    90 / teeth + involute(pressure) - involute(r > base ? acos(base / r) : 0) - 0.3;
function at(r, angle) = [r * cos(angle), r * sin(angle)];

function outline(teeth) =
    let (
        pitch = module_ * teeth / 2,
        foot = pitch - 1.2 * module_,
        flank = [for (k = [0 : 5]) foot + (2.2 * module_) * k / 5]
    )
    [for (i = [0 : teeth - 1]) each concat(
        [for (k = [0 : 5]) at(flank[k], 360 / teeth * i - half_tooth(flank[k], teeth))],
        [for (k = [5 : -1 : 0]) at(flank[k], 360 / teeth * i + half_tooth(flank[k], teeth))]
    )];

function bore(r, key) = concat(
    [for (a = [20 : 10 : 340]) at(r, a)],
    [[r + key, -sin(20) * r], [r + key, sin(20) * r]]
);

module blank(teeth, r) {
    teeth_points = outline(teeth);
    bore_points = bore(r, 1.8);
    n = len(teeth_points);
    polygon(
        points = concat(teeth_points, bore_points),
        paths = [[for (i = [0 : n - 1]) i], [for (i = [0 : len(bore_points) - 1]) n + i]]
    );
}

module hub(r, outer) difference() {
    circle(r = outer, $fn = 64);
    polygon(bore(r, 1.8));
}

color("darkgoldenrod") rotate(90) {
    linear_extrude(height = 8, convexity = 6) difference() {
        blank(24, 6);
        for (i = [0 : 5]) rotate(60 * i + 30) translate([20.5, 0]) circle(r = 6, $fn = 48);
    }
    translate([0, 0, 8]) linear_extrude(height = 5) hub(6, 11);
}

color("slategray") translate([module_ * 18, 0, 0]) rotate(180 + 180 / 12) {
    linear_extrude(height = 8, convexity = 6) blank(12, 4.5);
    translate([0, 0, 8]) linear_extrude(height = 5) hub(4.5, 9);
}

// A dovetail joint, halfway home. Tails and sockets are the same trapezoids; where they
// have met, their cheeks coincide.
thick = 12;
width = 80;
reach = 60;
lift = 5;                           // how far the upright board is still to go

module tails()
    for (y = [10 : 20 : 70])
        translate([0, y - width / 2]) polygon([[0, -4], [thick, -6.5], [thick, 6.5], [0, 4]]);

rotate(-90) translate([reach / 2, 0, reach / 2]) {
    color("sienna") translate([0, 0, -thick]) linear_extrude(height = thick) {
        translate([-reach, -width / 2]) square([reach, width]);
        tails();
    }
    color("burlywood") translate([0, 0, -lift]) difference() {
        translate([0, -width / 2, -reach]) cube([thick, width, reach]);
        translate([0, 0, -thick]) linear_extrude(height = thick) tails();
    }
}

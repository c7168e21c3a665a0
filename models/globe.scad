// The earth with one eighth lifted out: shells by nested differences, the inner core
// whole. The three modifiers are left in as one leaves them while drawing.
$fn = 60;

module eighth() translate([0, -100, 0]) cube(100);

module layer(outer, inner)
    difference() {
        difference() {
            sphere(r = outer);
            sphere(r = inner);
        }
        eighth();
    }

color("dodgerblue") layer(30, 28.5);
color("orangered") layer(28.5, 17);
color("orange") layer(17, 7);
#color("lightyellow") sphere(r = 7);

%difference() {                     // the air, only hinted at
    sphere(r = 32);
    sphere(r = 31);
}
*cylinder(h = 90, r = 0.5, center = true);      // the axis, switched off

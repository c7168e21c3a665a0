// A twisted vase: the outside is a mesh from vase.obj (see meshes.py), the hollow a
// cone frustum on a flattened ball.
color("mediumpurple") difference() {
    import("vase.obj", convexity = 6);
    translate([0, 0, 12]) cylinder(h = 50, r1 = 8.5, r2 = 13.5, $fn = 60);
    translate([0, 0, 12]) scale([1, 1, 0.6]) sphere(r = 8.5, $fn = 60);
}

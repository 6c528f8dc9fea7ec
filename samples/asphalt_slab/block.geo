// One element, 10 x 10 x 10 mm.
Point(1) = {0, 0, 0};
Point(2) = {10, 0, 0};
Line(1) = {1, 2};
Transfinite Curve{1} = 2;
bottom[] = Extrude {0, 10, 0} { Curve{1}; Layers{1}; Recombine; };
out[] = Extrude {0, 0, 10} { Surface{bottom[1]}; Layers{1}; Recombine; };
Physical Volume("asphalt") = {out[1]};
Physical Surface("base") = {bottom[1]};
Physical Surface("top") = {out[0]};
Physical Surface("left") = {out[5]};
Physical Surface("front") = {out[2]};

"""Does the train's speed change the uplift?  The same earthquake at three speeds."""

import railquake as rq

earthquake = {"seed": 18, "duration": "20 s", "pga": "1.0 g", "ground_frequency": "1.8 Hz"}
for speed in ("0.01 km/h", "80 km/h", "240 km/h"):
    case = rq.scenario(synthetic=earthquake, speed=speed, hinge="bouc-wen")
    row = rq.assess(rq.simulate(case))
    print(f"{speed:>10}: {row['status']}, uplift {row['uplift_ratio']:.3f} of the onset")
